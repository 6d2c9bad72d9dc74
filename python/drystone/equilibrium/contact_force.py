"""Forces at contact points: one as an object, all of an answer as arrays."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final, Literal, TypeAlias, overload

from drystone import _core
from drystone.common.text import place

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray


@dataclass(frozen=True, slots=True, repr=False)
class ContactForce:
    """The force that body `a` exerts on body `b` at one contact point, in newtons."""

    a: str
    b: str
    feature: str
    point: tuple[float, ...]
    """(x, y) in metres; in space (x, y, z)."""
    normal: tuple[float, ...]
    """Unit vector from `a` into `b`."""
    normal_force: float
    """N along `normal`; never negative: contacts push, they do not pull."""
    tangential_force: float
    """N along `normal` turned a quarter counter-clockwise; in space the size of what is square to
    the normal."""
    force: tuple[float, ...]
    """(x, y) in N; in space (x, y, z)."""
    at_borders: bool = False
    """Whether only borders meet here, such as a corner on a corner; see `Contact.at_borders`."""

    @classmethod
    def _of(cls, core: _core.ContactForce) -> ContactForce:
        return cls(
            core.a,
            core.b,
            core.feature,
            core.point,
            core.normal,
            core.normal_force,
            core.tangential_force,
            core.force,
            core.at_borders,
        )

    def __repr__(self) -> str:
        size = f"{self.normal_force:.4g} N normal, {self.tangential_force:.4g} N tangential"
        where = f"{self.a!r} on {self.b!r} at {place(self.point)}"
        return f"<ContactForce: {where}, {size}; {self.feature}>"


WhichForces: TypeAlias = Literal["canonical", "any"]
CANONICAL: Final = "canonical"
ANY: Final = "any"
"""Which contact forces: those of least norm, or those that a verdict was found with."""


def which_forces(forces: WhichForces) -> WhichForces:
    """ValueError unless it is "canonical" or "any"."""
    if forces not in (CANONICAL, ANY):
        raise ValueError(f'unknown forces {forces!r}: give "{CANONICAL}" or "{ANY}"')
    return forces


class ContactForces(Sequence[ContactForce]):
    """The forces at all contact points of an answer; computed when first asked for.

    A sequence of `ContactForce`, each made when it is asked for, and the same numbers as read-only
    arrays, one row a contact point:

    >>> import drystone as ds
    >>> forces = ds.check(ds.scenes.column(3)).forces
    >>> len(forces), forces[0].b, forces.normal_forces.round(3).tolist()
    (4, '1', [9.81, 9.81, 4.905, 4.905])
    """

    __slots__ = ("_found", "_kind", "_source")

    def __init__(
        self, source: _core.Forces | None, kind: str, found: _core.ContactForces | None = None
    ) -> None:
        self._source, self._kind, self._found = source, kind, found

    @property
    def _core(self) -> _core.ContactForces:
        found, source = self._found, self._source
        if found is None:
            assert source is not None
            found = None if self._kind == ANY else source.canonical()
            if found is None:
                self._kind, found = ANY, source.any()
            self._found = found
            self._source = None  # which holds the assembly
        return found

    @property
    def kind(self) -> str:
        """ "canonical", or "any": those that a verdict was found with. So also where the canonical
        ones are asked for, but cannot be found to the accuracy that a verdict needs."""
        _ = self._core  # it is not known before
        return self._kind

    def as_found(self) -> ContactForces:
        """Those that the verdict was found with, as long as no others have been computed."""
        return self if self._source is None else ContactForces(self._source, ANY)

    @property
    def bodies(self) -> NDArray[np.int64]:
        """(points, 2): `a` and `b` as places in `scene.bodies`."""
        return self._core.bodies()

    @property
    def points(self) -> NDArray[np.float64]:
        """(points, 2), in space (points, 3): where, metres."""
        return self._core.points()

    @property
    def normals(self) -> NDArray[np.float64]:
        """As many: unit vectors from `a` into `b`."""
        return self._core.normals()

    @property
    def vectors(self) -> NDArray[np.float64]:
        """As many: the forces of `a` on `b`, N."""
        return self._core.vectors()

    @property
    def normal_forces(self) -> NDArray[np.float64]:
        """(points,): N along the normals, never negative."""
        return self._core.normal_forces()

    @property
    def tangential_forces(self) -> NDArray[np.float64]:
        """(points,): N, as `ContactForce.tangential_force`."""
        return self._core.tangential_forces()

    @property
    def at_borders(self) -> tuple[ContactForce, ...]:
        """Those that bear where only borders meet."""
        if self._source is not None and not self._source.at_borders():
            return ()
        return tuple(self[k] for k in self._core.borders())

    def __len__(self) -> int:
        return len(self._core if self._source is None else self._source)

    @overload
    def __getitem__(self, index: int) -> ContactForce: ...
    @overload
    def __getitem__(self, index: slice) -> tuple[ContactForce, ...]: ...
    def __getitem__(self, index: int | slice) -> ContactForce | tuple[ContactForce, ...]:
        if isinstance(index, slice):
            return tuple(self[k] for k in range(*index.indices(len(self))))
        try:
            return ContactForce._of(self._core.at(range(len(self))[index]))
        except IndexError:
            raise IndexError(f"contact point {index} of {len(self)}") from None

    def __iter__(self) -> Iterator[ContactForce]:
        return (ContactForce._of(self._core.at(k)) for k in range(len(self)))

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, ContactForces | tuple):
            return NotImplemented
        return len(self) == len(other) and all(a == b for a, b in zip(self, other, strict=True))

    __hash__ = None  # type: ignore[assignment]

    def __repr__(self) -> str:
        return f"<ContactForces: {len(self)} contact points>"

    def __copy__(self) -> ContactForces:
        return self  # nobody can change it

    def __deepcopy__(self, memo: dict[int, Any]) -> ContactForces:
        return self

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self)._again, (self._core.to_bytes(), self._kind)

    @classmethod
    def _again(cls, state: bytes, kind: str) -> ContactForces:
        """What was pickled; DrystoneError if the bytes are none."""
        return cls(None, kind, _core.ContactForces.from_bytes(state))

    def json_lines(self, together: int = 4096) -> Iterator[str]:
        """JSON objects with the fields of `ContactForce`, one a line, some `together`."""
        for first in range(0, len(self), together):
            yield self._core.json(first, min(first + together, len(self)))
