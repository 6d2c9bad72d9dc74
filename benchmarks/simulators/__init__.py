"""The simulators, by the names used on the command line."""

from simulators import drystone, mujoco, rapier
from simulators.base import Motion, Simulator

__all__ = ["SIMULATORS", "Motion", "Simulator"]

SIMULATORS: dict[str, Simulator] = {
    "full": drystone.Drystone("full"),
    "motionless": drystone.Drystone("motionless"),
    "none": drystone.Drystone("none"),
    "rapier": rapier.Rapier(),
    "mujoco": mujoco.MuJoCo(),
}
"""`full` first: the others are compared with it."""
