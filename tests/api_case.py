"""Runs a script of a conformance suite and writes its answer: ``python -m api_case SCRIPT ANSWER [OLD NEW]``.

OLD and NEW: a text of the script, and what replaces it. The answer is JSON: the script's ``result``, or its ``error``.
A script that hangs ends with the stack of each thread on standard error.
"""

import faulthandler
import json
import math
import os
import sys
import traceback
import warnings
from pathlib import Path

import numpy as np
from waiting import PATIENCE

from ravemj.compat import alias


def main(script: Path, answer: Path, *replaced: str) -> None:
    faulthandler.dump_traceback_later(0.9 * PATIENCE, exit=True)
    warnings.simplefilter("ignore")
    alias.install_finder()
    space = {"__name__": "__main__", "__file__": script.name, "raises": raises}
    try:
        text = script.read_text()
        exec(compile(text.replace(*replaced) if replaced else text, script.name, "exec"), space)
        said = {"result": plain(space["result"])}
    except BaseException as error:
        said = {"error": "".join(traceback.format_exception(error))}
    answer.write_text(json.dumps(said))
    os._exit(0)  # without taking environments down


def raises(call):
    """None, or which exception a call raises; scripts use it."""
    import openravepy

    try:
        call()
    except openravepy.openrave_exception as error:
        return {"exception": "openrave_exception", "code": error.GetCode()}
    except Exception as error:
        return {"exception": type(error).__name__, "code": None}
    return None


def plain(value):
    """What JSON can hold, without losing the kinds of numbers."""
    if isinstance(value, np.ndarray):
        value = value.tolist()
    elif isinstance(value, np.generic):
        value = value.item()
    if isinstance(value, list | tuple):
        return [plain(item) for item in value]
    if isinstance(value, dict):
        return {str(key): plain(item) for key, item in value.items()}
    if isinstance(value, float) and not math.isfinite(value):
        return "NaN" if math.isnan(value) else "Infinity" if value > 0 else "-Infinity"
    if value is None or type(value) in {bool, int, float, str}:
        return value
    raise TypeError(f"{type(value).__name__} cannot be stored")


if __name__ == "__main__":
    main(Path(sys.argv[1]), Path(sys.argv[2]), *sys.argv[3:])
