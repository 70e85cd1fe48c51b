"""All routes, by their names."""

from __future__ import annotations

from differ import (
    bones,
    clearances,
    descriptions,
    planning,
    reaching,
    resting,
    tangencies,
    touches,
)

ROUTES = (
    *bones.ROUTES,
    *clearances.ROUTES,
    *reaching.ROUTES,
    *touches.ROUTES,
    *tangencies.ROUTES,
    *resting.ROUTES,
    *planning.ROUTES,
    *descriptions.ROUTES,
)
"""Every route, in the order of the table."""

BY_NAME = {route.name: route for route in ROUTES}
