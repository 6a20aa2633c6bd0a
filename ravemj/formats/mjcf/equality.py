"""Equality constraints for mimic joints, which are active when MuJoCo simulates.

A constraint is a polynomial of degree 4 at most in the value of one other joint minus that joint's ``ref``. Mimic
joints that are linear in several joints become fixed tendons.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ravemj.errors import Diagnostics
from ravemj.formats.mjcf.lines import XmlLines
from ravemj.model.mimic import leaders
from ravemj.model.scene import Joint

if TYPE_CHECKING:
    from ravemj.model.expressions import Expression

_TERMS = 5
_EXACT = 1e-9


@dataclass(slots=True)
class EqualityWriter:
    """Writes the constraints of bodies, one body after the other.

    Attributes:
        equalities: The constraints.
        tendons: The tendons of the constraints.
        solref: Time constant [s] and damping ratio of the constraints; None for MuJoCo's.
    """

    diagnostics: Diagnostics
    equalities: XmlLines
    tendons: XmlLines
    solref: tuple[float, float] | None = None

    def write(self, joints: Sequence[Joint], names: Sequence[tuple[str, ...]]) -> None:
        """Write the constraints of a body.

        Args:
            joints: Active joints, then passive ones.
            names: Names of the joints in the MJCF; empty for joints that move nothing.
        """
        for joint, joint_names in zip(joints, names, strict=True):
            equation = joint.equation
            if equation is None or not joint_names:
                continue
            expression = _without_welds(equation, joints, names)
            moving = leaders(expression)
            if any(joints[index].is_ball for index in moving):
                self._drop(joint, "follows a spherical joint")
            elif len(moving) <= 1:
                self._write_polynomial(joint, joint_names[0], expression, joints, names)
            else:
                self._write_tendon(joint, joint_names[0], expression, joints, names)

    def _write_polynomial(
        self,
        joint: Joint,
        name: str,
        expression: "Expression",
        joints: Sequence[Joint],
        names: Sequence[tuple[str, ...]],
    ) -> None:
        moving = leaders(expression)
        if not moving:
            coefficients = [expression.evaluate({}) - joint.axes[0].reference]
            leader_name = None
        else:
            leader = joints[moving[0]]
            coefficients = self._coefficients(joint, leader, expression)
            if shift := leader.axes[0].reference:
                moved = np.polynomial.Polynomial(coefficients)(np.polynomial.Polynomial([shift, 1]))
                coefficients = moved.coef.tolist()
            coefficients[0] -= joint.axes[0].reference
            leader_name = names[moving[0]][0]
        if not np.isfinite(coefficients).all():
            self._drop(joint, "follows a formula without finite values")
            return
        padded = tuple((coefficients + [0.0] * _TERMS)[:_TERMS])
        self.equalities.element(
            "joint", joint.source, joint1=name, joint2=leader_name, polycoef=padded, solref=self.solref
        )

    def _coefficients(self, joint: Joint, leader: Joint, expression: "Expression") -> list[float]:
        """Return the polynomial coefficients of a mimic joint's equation: exact, or fitted over the leader's range."""
        variable = expression.variables[0]
        exact = expression.polynomial(variable)
        if exact is not None:
            return list(exact)
        axis = leader.axes[0]
        lower, upper = (-np.pi, np.pi) if axis.circular else (axis.lower, axis.upper)
        from ravemj.model.expressions import fit_polynomial  # noqa: PLC0415 - rarely wanted

        coefficients, error = fit_polynomial(expression, variable, lower, upper)
        if not np.isfinite(error):
            coefficients = (0.0,)
        if not error < _EXACT:
            message = (
                f"joint '{joint.name}' follows no polynomial; the MJCF has one of degree 4 that is off by up to "
                f"{error:.3g} between {lower:.6g} and {upper:.6g}"
            )
            self.diagnostics.warn("fitted-mimic", message, joint.source)
        return list(coefficients)

    def _write_tendon(
        self,
        joint: Joint,
        name: str,
        expression: "Expression",
        joints: Sequence[Joint],
        names: Sequence[tuple[str, ...]],
    ) -> None:
        slopes = {variable: expression.derivative(variable) for variable in expression.variables}
        if any(slope.variables for slope in slopes.values()):
            self._drop(joint, "follows several joints in a way that MJCF cannot say")
            return
        constant = expression.evaluate(dict.fromkeys(expression.variables, 0.0))
        tendon = f"{name}/follows"
        self.tendons.open("fixed", joint.source, name=tendon)
        self.tendons.element("joint", joint.source, joint=name, coef=1.0)
        rest = joint.axes[0].reference
        for variable, slope in slopes.items():
            index = int(variable.removeprefix("joint"))
            factor = slope.evaluate({})
            rest -= factor * joints[index].axes[0].reference
            self.tendons.element("joint", joint.source, joint=names[index][0], coef=-factor)
        self.tendons.close("fixed")
        offset = (constant - rest, 0.0, 0.0, 0.0, 0.0)
        self.equalities.element("tendon", joint.source, tendon1=tendon, polycoef=offset, solref=self.solref)

    def _drop(self, joint: Joint, reason: str) -> None:
        self.diagnostics.warn("dropped-mimic", f"joint '{joint.name}' {reason}; it is free there", joint.source)


def _without_welds(expression: "Expression", joints: Sequence[Joint], names: Sequence[tuple[str, ...]]) -> "Expression":
    """Return a mimic expression with the values of fixed joints inserted as constants."""
    fixed = {f"joint{index}": joints[index].axes[0].value for index in leaders(expression) if not names[index]}
    return expression.with_values(fixed) if fixed else expression
