"""Courses: exercises that check themselves, recognize classical mistakes, and show an answer beside the right one.

A course is a folder of lessons. A lesson is a folder with a page ``index.md`` and exercises: the file that a student
completes, such as ``fk_1.py``, and its check, ``check_fk_1.py``, which defines ``CHECK``, a ``Check``.
"""

from ravemj.learn.check import Check as Check
from ravemj.learn.check import Scene as Scene
