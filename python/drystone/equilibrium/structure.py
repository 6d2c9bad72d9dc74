"""A structure that is put up and taken down block by block: does it stand now?"""

from __future__ import annotations

import copy
from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

from drystone import _core
from drystone.common.cones import FACETS, INSCRIBED, Pyramid, core_cones
from drystone.common.drawn import Paged
from drystone.common.numbers import Floats, name_of, names_of
from drystone.equilibrium.contact_force import CANONICAL, WhichForces, which_forces
from drystone.equilibrium.limits import Limit, Push, core_push, limit_of
from drystone.equilibrium.verdict import Verdict
from drystone.scene import Scene
from drystone.scene.scene import scene_of

if TYPE_CHECKING:
    from typing_extensions import Self


class Structure(Paged):
    """A scene of which some blocks are there and others not: does it stand now?

    Blocks are added and removed in any order. Between two questions the contacts of the complete
    scene, the forces and their factored matrix are kept, so an answer costs only what the change
    reaches. On a tall stack that is a block or two, not the way to the ground.

    >>> import drystone as ds
    >>> structure = ds.Structure(ds.scenes.pyramid(3), blocks=["1", "2", "3"])  # the lowest row
    >>> structure.add("4", "5")
    >>> structure.stands()
    True
    >>> structure.remove("1", "2")
    >>> structure.stands(), structure.check().falling
    (False, ('4',))

    Raises SceneError for a scene in which blocks overlap, and for a name that no movable body has.
    `facets` and `cone` are as in `plan`.

    `copy.copy`, `copy.deepcopy` and `pickle` make independent structures, with the forces and the
    factor as they are, so they answer with the same numbers. One thread at a time may use a
    structure; a second one gets a BusyError, and nothing has changed.
    """

    __slots__ = ("_cones", "_core", "_index", "_names", "_scene")

    def __init__(
        self,
        scene: Scene,
        blocks: Iterable[str] = (),
        *,
        facets: int = FACETS,
        cone: Pyramid = INSCRIBED,
    ) -> None:
        self._scene = copy.copy(scene_of(scene))
        self._cones = core_cones(facets, cone)
        self._hold(_core.Structure(scene._core, self._cones))
        self.add(*(names_of(blocks) or ()))

    def _hold(self, core: _core.Structure) -> None:
        self._core = core
        self._names = tuple(core.names())
        self._index = {name: block for block, name in enumerate(self._names)}

    def __repr__(self) -> str:
        return f"<Structure: {len(self.blocks)} of {len(self._names)} blocks>"

    @property
    def blocks(self) -> tuple[str, ...]:
        """Names of the movable bodies that are there, in the order of the scene."""
        return tuple(self._names[block] for block in self._core.blocks())

    def add(self, *blocks: str) -> None:
        """Put blocks up where the scene has them; those that are there already stay."""
        self._core.change([], self._indices(blocks))

    def remove(self, *blocks: str) -> None:
        """Take blocks away; those that are not there stay away."""
        self._core.change(self._indices(blocks), [])

    def stands(self) -> bool | None:
        """Whether some forces within the friction cones balance every block that is there; None if
        that is borderline (see `Verdict.status`).

        Raises DrystoneError if the solver ends without an answer.
        """
        return self._core.step([], [])[0]

    def check(self, *, forces: WhichForces = CANONICAL) -> Verdict:
        """The verdict with all contact forces, or how it begins to fall; as `check` gives it."""
        kind = which_forces(forces)
        return Verdict._of(self._core.check(), copy.copy(self._scene), self._cones[1], kind)

    def limit(self, push: Push | None = None, gravity: Floats | None = None) -> Limit:
        """How much of a push the structure bears as it is now; `push` and `gravity` as in `limit`.

        It begins with the forces that hold the structure. If that takes more than a few pivots, the
        interior-point method is used. In space the friction cones are the structure's pyramids.

        >>> import drystone as ds
        >>> scene = ds.scenes.pyramid(3, friction=0.5)
        >>> structure = ds.Structure(scene, blocks=["1", "2", "3", "4"])
        >>> round(structure.limit(push={"4": (9.81, 0)}).factor, 6)
        0.5
        """
        forces, pull = core_push(self._scene, push, gravity)
        core = self._core.limit(self._scene._core, forces, pull)
        return limit_of(core, copy.copy(self._scene), self.blocks, forces, pull)

    @property
    def pivots(self) -> int:
        """Pivots made so far, for all answers together."""
        return self._core.pivots()

    @property
    def entries(self) -> int:
        """Numbers that the factor holds now."""
        return self._core.entries()

    def __copy__(self) -> Self:
        twin = type(self).__new__(type(self))
        twin._scene, twin._cones = copy.copy(self._scene), self._cones
        twin._hold(self._core.copy())
        return twin

    def __deepcopy__(self, memo: dict[int, Any]) -> Self:
        return self.__copy__()

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self)._again, (self._scene, self._cones, self._core.to_bytes())

    @classmethod
    def _again(cls, scene: Scene, cones: tuple[int, str], state: bytes) -> Self:
        """What was pickled; DrystoneError if the state is not one of this scene."""
        structure = cls.__new__(cls)
        structure._scene, structure._cones = scene, cones
        structure._hold(_core.Structure.from_bytes(scene._core, cones, state))
        return structure

    def _indices(self, blocks: Iterable[str]) -> list[int]:
        return [self._block(name) for name in blocks]

    def _block(self, name: str) -> int:
        block = self._index.get(name_of(name))
        if block is None:
            body = self._scene.body(name)  # raises if there is none
            raise _core.SceneError(f"body {body.name!r} is fixed: it is always there")
        return block
