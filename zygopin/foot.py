"""The foot's parameters: fingers, phalanges, and the numbers that shape them."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from zygopin import checks, kinds
from zygopin.errors import FileError, ParameterError, UnknownNameError, ZygopinError
from zygopin.files import as_path
from zygopin.finger import Finger, zygodactyl_fingers
from zygopin.presets import read_parameters, read_preset

GOLDEN_MEAN = (1 + math.sqrt(5)) / 2
"""The scaling factor ρ of the source's foot."""

MAX_FINGERS = 12
"""Fingers a foot may have."""

SIDEWAYS = 1e-9
"""Cosine of an azimuth below which a finger points neither forward nor back."""

SHORTEST = 1e-12
"""Least length of a phalanx over the foot's size: the ends of one that is shorter are
rounded to the same place, or nearly so, and it has no direction."""

_METADATA = ("description", "sources")


@dataclass(frozen=True)
class Foot:
    """The parameters of a foot (MODEL.md, section 1).

    Phalanx k of each finger has length scale·ρ^-k and radius thickness·ρ^-k.

    Attributes:
        rho: Scaling factor ρ > 1 between a phalanx and the next.
        omega: Largest joint angle ω, in (0, 2π) without π [rad].
        splay: Angle Ω between the fingers' planes and the xz-plane [rad].
        scale: The length s [m].
        thickness: The skin's radius before scaling, ≥ 0 [m]; 0: bare bones.
        density: Mass density of the phalanges [kg/m³].
        fingers: The fingers in order; empty: the zygodactyl four at this splay.
        name: Lower-case identifier, the robot's name in its URDF.
    """

    rho: float = GOLDEN_MEAN
    omega: float = math.pi / 6
    splay: float = math.pi / 12
    scale: float = 1.0
    thickness: float = 0.0
    density: float = 1100.0
    fingers: tuple[Finger, ...] = ()
    name: str = "foot"

    def __post_init__(self) -> None:
        kinds.identifier("name", self.name)
        for field, (allowed, where, remedy) in _RANGES.items():
            value = checks.number(
                field,
                getattr(self, field),
                allowed=allowed,
                where=where,
                remedy=remedy,
            )
            object.__setattr__(self, field, value)
        fingers = _listed(self.fingers) or zygodactyl_fingers(self.splay)
        object.__setattr__(self, "fingers", _checked_fingers(fingers))
        _check_thickness(self.thickness, self.scale)
        _check_shortest(self)

    @classmethod
    def preset(cls, name: str) -> Foot:
        """A shipped foot.

        Args:
            name: One of `preset_names()`.

        Returns:
            The foot, named after the preset.

        Raises:
            UnknownNameError: There is no preset of that name.
        """
        return cls.from_mapping(read_preset(name))

    @classmethod
    def load(cls, path: Path | str) -> Foot:
        """A foot from a YAML file.

        Args:
            path: The file: a mapping of this class's fields [SI].

        Returns:
            The foot.

        Raises:
            FileError: The file cannot be read, or holds no valid foot.
        """
        path = as_path(path)
        try:
            return cls.from_mapping(read_parameters(path))
        except FileError:
            raise
        except ZygopinError as error:
            raise FileError(path, str(error), "mend this value") from error

    @classmethod
    def from_mapping(cls, mapping: Mapping[str, Any]) -> Foot:
        """A foot from plain values, as a preset's file holds them.

        Args:
            mapping: Fields of this class; fingers as a list of mappings.
                `description` and `sources` are passed over.

        Returns:
            The foot.

        Raises:
            UnknownNameError: A field does not exist.
            ParameterError: A value is not allowed.
        """
        if not isinstance(mapping, Mapping):
            remedy = "give names of fields and their values"
            raise ParameterError("mapping", mapping, "a mapping", remedy)
        values = {key: mapping[key] for key in mapping if key not in _METADATA}
        fingers = _listed(values.pop("fingers", ()))
        if "fingers" in mapping and not fingers:
            remedy = "list the fingers, or leave the field out for the zygodactyl four"
            raise ParameterError("fingers", mapping["fingers"], "a filled list", remedy)
        _check_fields(cls, values)
        return cls(**values, fingers=tuple(map(_finger, fingers)))

    def to_mapping(self) -> dict[str, Any]:
        """The foot as plain values: what `from_mapping` reads, and JSON and YAML."""
        return {
            **dataclasses.asdict(self),
            "fingers": [*map(dataclasses.asdict, self.fingers)],
        }

    def replace(self, **changes: Any) -> Foot:  # noqa: ANN401
        """This foot with some fields changed.

        A new splay turns each finger by its `splay_gain` times the change, unless
        new fingers are given as well.

        Args:
            **changes: New values of this class's fields.

        Returns:
            The new foot.

        Raises:
            UnknownNameError: A field does not exist.
            ParameterError: A value is not allowed.
        """
        _check_fields(type(self), changes)
        if "splay" not in changes or "fingers" in changes:
            return dataclasses.replace(self, **changes)
        # Validated first: a splay out of range must not reach the azimuths.
        new = dataclasses.replace(self, **changes)
        turned = (_splayed(finger, new.splay - self.splay) for finger in self.fingers)
        return dataclasses.replace(new, fingers=tuple(turned))

    @cached_property
    def finger_slices(self) -> dict[str, slice]:
        """Where each finger's phalanges stand among all P of them."""
        ends = np.cumsum([finger.phalanges for finger in self.fingers])
        return {
            finger.name: slice(int(end) - finger.phalanges, int(end))
            for finger, end in zip(self.fingers, ends, strict=True)
        }

    @cached_property
    def phalanx_count(self) -> int:
        """P, the number of phalanges of all fingers together."""
        return sum(finger.phalanges for finger in self.fingers)

    @cached_property
    def finger_of_phalanx(self) -> NDArray[np.intp]:
        """Index of the finger that each phalanx belongs to, shape (P,)."""
        counts = [finger.phalanges for finger in self.fingers]
        return _frozen(np.repeat(np.arange(len(self.fingers)), counts))

    @cached_property
    def rank_of_phalanx(self) -> NDArray[np.intp]:
        """Number k of each phalanx in its finger, from 1, shape (P,)."""
        ranks = [np.arange(1, finger.phalanges + 1) for finger in self.fingers]
        return _frozen(np.concatenate(ranks))

    @cached_property
    def lengths(self) -> NDArray[np.float64]:
        """Lengths scale·ρ^-k of the phalanges [m], shape (P,)."""
        return _frozen(self.scale * self.rho ** -self.rank_of_phalanx.astype(float))

    @cached_property
    def radii(self) -> NDArray[np.float64]:
        """Skin radii thickness·ρ^-k of the phalanges [m], shape (P,)."""
        return _frozen(self.thickness * self.rho ** -self.rank_of_phalanx.astype(float))

    @cached_property
    def size(self) -> float:
        """Length of the longest finger [m]: the unit of relative tolerances."""
        return max(
            float(self.lengths[part].sum()) for part in self.finger_slices.values()
        )

    @cached_property
    def opposable_pairs(self) -> tuple[tuple[int, int], ...]:
        """Pairs of finger indices, one pointing forward and one back."""
        ahead = np.cos([finger.azimuth for finger in self.fingers])
        indices = range(len(self.fingers))
        return tuple(
            (i, j)
            for i in indices
            for j in indices
            if i < j
            and min(abs(ahead[i]), abs(ahead[j])) > SIDEWAYS
            and ahead[i] * ahead[j] < 0
        )


_RANGES: dict[str, Any] = {
    "rho": (
        "a number above 1, up to 100",
        lambda x: 1 < x <= 100,
        "phalanges shrink by ρ: give a number such as 1.2",
    ),
    "omega": (
        "in (0, 2π) and different from π",
        lambda x: 0 < x < 2 * math.pi and x != math.pi,
        "give radians, such as 0.5236 for 30°",
    ),
    "splay": (
        "in [0, π/2)",
        lambda x: 0 <= x < math.pi / 2,
        "give radians, such as 0.2618 for 15°",
    ),
    "scale": (
        "in [1e-6, 1e6]",
        lambda x: 1e-6 <= x <= 1e6,
        "give metres, such as 0.016 for 16 mm",
    ),
    "thickness": (
        "zero or a positive number",
        lambda x: x >= 0,
        "give metres, or 0 for bare bones",
    ),
    "density": (
        "in [1e-3, 1e6]",
        lambda x: 1e-3 <= x <= 1e6,
        "give kg/m³, such as 1100",
    ),
}


def _check_thickness(thickness: float, scale: float) -> None:
    """A skin as thick as its bone is long leaves no finger."""
    if thickness >= scale:
        raise ParameterError(
            "thickness",
            thickness,
            f"below the scale {scale:g} m",
            "give a skin's radius smaller than the phalanges are long",
        )


def _check_shortest(foot: Foot) -> None:
    """A phalanx that is lost in the rounding of its finger is none."""
    share = float(foot.lengths.min()) / foot.size
    if share < SHORTEST:
        most = max(finger.phalanges for finger in foot.fingers)
        name = f"length of phalanx {most} over the foot's size"
        # The longest finger is hardly longer than its first phalanx, where ρ is large.
        largest = 0.9 * SHORTEST ** (-1 / (most - 1))
        remedy = f"take fewer phalanges, or a rho of at most {largest:.3g}"
        raise ParameterError(name, share, f"at least {SHORTEST:g}", remedy)


def _listed(fingers: object) -> tuple[Any, ...]:
    """The fingers as a tuple."""
    if not isinstance(fingers, (list, tuple)):
        raise ParameterError("fingers", fingers, "a list", "list the fingers")
    return tuple(fingers)


def _checked_fingers(fingers: tuple[Finger, ...]) -> tuple[Finger, ...]:
    """The fingers, each of the right type, their names distinct."""
    checks.integer("number of fingers", len(fingers), 1, MAX_FINGERS)
    seen: set[str] = set()
    for finger in fingers:
        if not isinstance(finger, Finger):
            raise ParameterError("finger", finger, "a Finger", "use zygopin.Finger")
        if finger.name in seen:
            raise ParameterError(
                "finger.name", finger.name, "used once", "give each finger its own name"
            )
        seen.add(finger.name)
    return fingers


def _check_fields(cls: type, values: Mapping[str, Any]) -> None:
    """Every key names a field of the dataclass."""
    known = [field.name for field in dataclasses.fields(cls)]
    for key in values:
        if key not in known:
            raise UnknownNameError(f"field of {cls.__name__.lower()}", key, known)


def _finger(mapping: object) -> Finger:
    """A finger from plain values."""
    if not isinstance(mapping, Mapping):
        raise ParameterError("finger", mapping, "a mapping", "give name: value pairs")
    _check_fields(Finger, mapping)
    for field in ("name", "phalanges", "azimuth"):
        if field not in mapping:
            raise ParameterError(f"finger.{field}", None, "given", f"add {field}")
    return Finger(**mapping)


def _splayed(finger: Finger, change: float) -> Finger:
    """The finger after the splay has changed."""
    azimuth = finger.azimuth + finger.splay_gain * change
    return dataclasses.replace(finger, azimuth=azimuth)


def _frozen(values: NDArray[Any]) -> NDArray[Any]:
    """The array, read-only."""
    values.setflags(write=False)
    return values
