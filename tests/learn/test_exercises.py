"""Every exercise: its solution passes, its hole fails with a sentence, and the mistakes it lists are named."""

from pathlib import Path

import numpy as np
import pytest

from ravemj.learn.child import check_file, load_check, questions
from ravemj.learn.course import our_course
from ravemj.learn.mistakes import recognized

SOLUTIONS = Path(__file__).parent / "solutions"
EXERCISES = our_course().exercises


@pytest.mark.parametrize("exercise", EXERCISES, ids=lambda one: one.name)
class TestExercise:
    def test_the_solution_passes(self, exercise):
        check = load_check(exercise.check)
        for seed in (0, 1):
            verdict = check_file(SOLUTIONS / exercise.original.name, check, seed)
            assert verdict.status == "solved", verdict

    def test_the_hole_is_named(self, exercise):
        verdict = check_file(exercise.original, load_check(exercise.check), 0)
        assert verdict.status == "untouched"
        assert "still has ... in it: put your" in verdict.message

    def test_it_has_what_a_student_needs(self, exercise):
        check = load_check(exercise.check)
        assert len(check.hints) == len(set(check.hints)) == 3
        assert check.questions >= 20 or callable(check.function)
        assert exercise.original.read_text(encoding="utf-8").splitlines()[0].count(f"{exercise.name}: ") == 1

    def test_its_mistakes_are_named(self, exercise):
        check = load_check(exercise.check)
        asked = questions(check, 2)
        for sentence, mistake in check.mistakes.items():
            given = [np.asarray(mistake(*arguments), dtype=float) for arguments in asked]
            assert any(check.complaint(one, arguments) for one, arguments in zip(given, asked, strict=True)), sentence
            assert recognized(check, asked, given) == sentence
