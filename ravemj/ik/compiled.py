"""Forward kinematics and Jacobians of one configuration by MuJoCo; for batches the numpy of ``Chain`` is faster."""

import itertools

import mujoco
import numpy as np

from ravemj.ik.chain import Chain
from ravemj.ik.vectors import Floats


class CompiledKinematics:
    """A chain as a model of MuJoCo: a factory of poses and Jacobians that can be pickled and called from one thread.

    Attributes:
        chain: The chain.
        model: The model.
        data: Its state.
    """

    def __init__(self, chain: Chain) -> None:
        self.chain = chain
        self.model = mujoco.MjModel.from_xml_string(_mjcf(chain))
        self.data = mujoco.MjData(self.model)
        self._qpos, self._place = self.data.qpos, self.data.site_xpos[0]
        self._rows = self.data.site_xmat[0].reshape(3, 3)
        self._jacobian = np.zeros((6, chain.dof))
        self._parts = self._jacobian[:3], self._jacobian[3:]

    def __reduce__(self) -> tuple[type["CompiledKinematics"], tuple[Chain]]:
        return CompiledKinematics, (self.chain,)

    def __call__(self, values: Floats) -> tuple[Floats, Floats, Floats]:
        """Return the tool's rotation (3, 3), its place (3,) and the Jacobian (6, n); the next call overwrites them."""
        self._qpos[:] = values
        mujoco.mj_kinematics(self.model, self.data)
        mujoco.mj_comPos(self.model, self.data)
        mujoco.mj_jacSite(self.model, self.data, *self._parts, 0)
        return self._rows, self._place, self._jacobian


def _mjcf(chain: Chain) -> str:
    """Write a chain as bodies whose axes are parallel to the base's when all values are 0."""
    points = np.vstack([np.zeros(3), chain.points, chain.T_base_tool[:3, 3]])
    steps = [_text(step) for step in np.diff(points, axis=0)]
    kinds = ("slide" if sliding else "hinge" for sliding in chain.prismatic.tolist())
    bodies = [
        f'<body pos="{step}"><inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/>'
        f'<joint type="{kind}" axis="{_text(axis)}"/>'
        for step, kind, axis in zip(steps, kinds, chain.axes, strict=False)
    ]
    axes = " ".join(map(_text, chain.T_base_tool[:3, :2].T))
    site = f'<site pos="{steps[-1]}" xyaxes="{axes}"/>'
    inside = "".join(itertools.chain(bodies, [site], ["</body>"] * len(bodies)))
    return f'<mujoco><compiler angle="radian"/><worldbody>{inside}</worldbody></mujoco>'


def _text(numbers: Floats) -> str:
    return " ".join(map(repr, numbers.tolist()))
