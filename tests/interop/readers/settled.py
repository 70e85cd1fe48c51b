"""Mimic as a tool's simulation shows it, where its model does not tell."""

ANGLES = 0.1, 0.3
"""Two places for the leader [rad], within every foot's limits."""


def mimics_seen(leader, settle):
    """A line through two places to which each follower is drawn.

    Args:
        leader: The name of the leader.
        settle: Takes the leader's angle, returns {follower: its angle once settled}.

    Returns:
        {follower: (leader, multiplier, offset)}.
    """
    (near, far), (one, two) = ANGLES, map(settle, ANGLES)
    slopes = {name: (two[name] - one[name]) / (far - near) for name in one}
    return {
        name: (leader, slope, one[name] - slope * near)
        for name, slope in slopes.items()
    }
