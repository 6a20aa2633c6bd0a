"""Numbers and texts of users, by name."""

# The fields have the names that OpenRAVE gives them.
# pyright: reportPrivateUsage=false

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Self

import numpy as np
from numpy.typing import ArrayLike

from ravemj.core.arrays import checked_numbers
from ravemj.model.scene import Parameters
from ravemj.rave.infos.base import Info


@dataclass(eq=False, repr=False)
class ParameterFields(Info):
    """The fields of links and joints that hold parameters."""

    _mapFloatParameters: Mapping[str, ArrayLike] = field(default_factory=dict[str, ArrayLike])
    _mapIntParameters: Mapping[str, ArrayLike] = field(default_factory=dict[str, ArrayLike])
    _mapStringParameters: Mapping[str, str] = field(default_factory=dict[str, str])

    def with_parameters(self, parameters: Parameters) -> Self:
        """Take over parameters; return this object."""
        self._mapFloatParameters = {name: np.array(values) for name, values in parameters.floats}
        self._mapIntParameters = {name: np.array(values, dtype=np.int_) for name, values in parameters.integers}
        self._mapStringParameters = dict(parameters.texts)
        return self

    def parameters(self) -> Parameters:
        """Return the parameters that the fields hold."""
        floats = {name: checked_numbers(values, name).ravel() for name, values in self._mapFloatParameters.items()}
        integers = {name: checked_numbers(values, name).ravel() for name, values in self._mapIntParameters.items()}
        return Parameters(
            tuple((name, tuple(values.tolist())) for name, values in floats.items()),
            tuple((name, tuple(values.astype(np.int_).tolist())) for name, values in integers.items()),
            tuple((name, str(text)) for name, text in self._mapStringParameters.items()),
        )
