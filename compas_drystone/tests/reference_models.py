"""The models of compas_dem's `scripts/DEM_Analysis_References`, and a stone for them."""

from __future__ import annotations

from compas.geometry import Box
from compas_dem.material import Stone
from compas_dem.models import BlockModel
from compas_dem.problem import Problem
from compas_dem.templates import ArchTemplate, BarrelVaultTemplate

FRICTION = 0.5
DENSITY = 2000.0


def two_blocks() -> BlockModel:
    return _of_boxes([_box((0, 0, -0.1), 1, 0.1), _box((0, 0, 0), 1, 1), _box((0, 0, 1), 1, 1)])


def three_blocks() -> BlockModel:
    feet = [_box((0, 0, 0), 1, 1), _box((1.1, 0, 0), 1, 1)]
    return _of_boxes([_box((0, 0, -0.1), 2.1, 0.1), *feet, _box((0.55, 0, 1), 1, 1)])


def arch() -> BlockModel:
    template = ArchTemplate(rise=4.393, span=21.213, thickness=0.5, depth=3.0, n=30)
    model = BlockModel.from_template(template)
    model.add_supports([0, 29])
    return model


def barrel_vault() -> BlockModel:
    template = BarrelVaultTemplate(length=3, span=7, rise=0.1, vou_length=13)
    model = BlockModel.from_barrelvault(template)
    model.compute_contacts()
    for node in model.graph.nodes_where(degree=1):
        model.graph.node_element(node).is_support = True
    return model


def problem_of(model: BlockModel, friction: float = FRICTION) -> Problem:
    """Of dry stone, under its own weight."""
    stone = Stone.from_predefined_material("LimeStone")
    stone.density = DENSITY
    model.add_material(stone)
    model.assign_material(stone, elements=list(model.elements()))
    problem = Problem(model)
    problem.set_contact_model("MohrCoulomb", mu=friction)
    return problem


def _box(corner: tuple[float, float, float], width: float, height: float) -> Box:
    x, y, z = corner
    return Box.from_corner_corner_height([x, y, z], [x + width, y + 1, z], height)


def _of_boxes(boxes: list[Box]) -> BlockModel:
    """The lowest is the support."""
    model = BlockModel.from_boxes(boxes)
    lowest = min(model.elements(), key=lambda block: block.point[2])
    lowest.is_support = True
    return model
