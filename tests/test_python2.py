"""Scripts written for Python 2: what they mean, where their errors are, and how ``ravemj run --py2`` runs them."""

import re
import traceback
from fractions import Fraction

import numpy as np
import pytest
from command_line import ravemj_command
from hypothesis import given
from hypothesis import strategies as st

from ravemj.compat import python2
from ravemj.compat.python2.division import divide


def run(source: str, path: str = "old.py") -> dict[str, object]:
    space = {"__name__": "__main__"}
    python2.execute(source.encode(), path, space)
    return space


@pytest.mark.parametrize(
    ("expression", "value"),
    [
        ("7 / 2", 3),
        ("-7 / 2", -4),
        ("7 / 2.", 3.5),
        ("7 // 2", 3),
        ("True / 2", 0),
        ("1 / 2 / 3. + 5 / 3", 1.0),
        ("numpy.array([7, 8]) / 2", [3, 4]),
        ("numpy.array([7., 8]) / 2", [3.5, 4]),
        ("numpy.int64(7) / 2", 3),
        ("numpy.array([7, 8])[0] / 2", 3),
        ("Fraction(7) / 2", Fraction(7, 2)),
        ("0777 + 0x10L + 10L", 511 + 16 + 10),
        ("`7` + repr(u'a') + str(unicode('b'))", "7'a'b"),
        ("3 <> 4", True),
        ("{1: 2}.has_key(1)", True),
        ("range(2) + {3: 4}.keys() + map(lambda (a, b): a + b, zip([1], [2]))", [0, 1, 3, 3]),
        ("reduce(lambda a, b: a * b, xrange(1, 5))", 24),
        ("isinstance(3, (int, long)) and isinstance('a', basestring)", True),
        ("string.letters[:2] + string.uppercase[-1]", "abZ"),
        ("cmp(1, 2), cmp([2], [1]), cmp('a', 'a')", (-1, 1, 0)),
        ("file.__name__", "File"),
        ("iter([5]).next()", 5),
    ],
)
def test_expressions_mean_what_they_did(expression, value):
    text = f"import numpy, string\nfrom fractions import Fraction\nresult = {expression}\n"
    result = run(text)["result"]
    assert np.asarray(result).tolist() == np.asarray(value).tolist()
    assert isinstance(result, np.ndarray | np.generic) or type(result) is type(value)


@pytest.mark.parametrize(
    ("statements", "value"),
    [
        ("x = 7; x /= 2", 3),
        ("x = 7; x /= 2.", 3.5),
        ("x = numpy.array([7, 8]); y = x; x /= 2; assert x is y", [3, 4]),
        ("x = numpy.array([7., 8]); y = x; x /= 2; assert x is y", [3.5, 4]),
        ("x = numpy.array([7, 8]); x[0] /= 2", [3, 8]),
        ("x = [0, 9]; x[x.index(9)] /= 2", [0, 4]),
        ("exec 'x = 5'", 5),
        ("try:\n    raise ValueError, 'five'\nexcept ValueError, e:\n    x = str(e)", "five"),
        ("class A:\n    def __div__(self, other): return 'divided'\nx = A() / 2", "divided"),
        ("class A:\n    def __idiv__(self, other): return other\nx = A(); x /= 3", 3),
        ("class A:\n    def __rdiv__(self, other): return other\nx = 'a' / A()", "a"),
        ("class M(type): made = 3\nclass A(object):\n    __metaclass__ = M\nx = A.made", 3),
        ("if True:\n\tx = 1\n        x += 1", 2),
        ("if True:\n    x = '''\t|'''\n", "\t|"),
        ("def f(a, (b, c)):\n    return c\nx = f(1, (2, 3))", 3),
    ],
)
def test_statements_do_what_they_did(statements, value):
    assert np.asarray(run(f"import numpy\n{statements}\n")["x"]).tolist() == value


def test_printing(capsys):
    run("import sys\nprint 'a',\nprint 'b', 3\nprint\nprint('c')\nprint >>sys.stderr, 'd'\n")
    assert capsys.readouterr() == ("a b 3\n\nc\n", "d\n")


def test_files_that_ask_for_true_division_get_it():
    assert run("from __future__ import print_function, division\nprint(1, end='')\nx = 3 / 2\n")["x"] == 1.5


def test_what_only_python_3_understands_is_taken_as_it_is():
    assert run("match 3:\n    case y:\n        x = y / 2\n")["x"] == 1.5


@given(st.integers(-1000, 1000), st.integers(-20, 20).filter(bool))
def test_integers_are_divided_downwards(a, b):
    assert divide(a, b) == a // b
    assert divide(float(a), b) == a / b


LONG = '''"""Doc
string."""
import urllib2, operator
from itertools import izip, imap

def f(x):
    text = """a
    b"""
    print text, sys.maxint  \\
        , operator.isCallable(f)

    y = reduce(lambda a, b: a + b, [1])
    return (1 +
            x / 0)

try:
    f(
        1)
except ZeroDivisionError, e:
    raise
'''


def test_tracebacks_name_the_lines_of_the_original(tmp_path):
    path = tmp_path / "long.py"
    path.write_text("import sys\n" + LONG)
    with pytest.raises(ZeroDivisionError) as caught:
        run("import sys\n" + LONG, str(path))
    frames = [frame for frame in traceback.extract_tb(caught.value.__traceback__) if frame.filename == str(path)]
    assert [(frame.name, frame.line) for frame in frames] == [("<module>", "f("), ("f", "x / 0)")]


@pytest.mark.parametrize(
    ("text", "line", "shown"),
    [("x = 1\nprint x\ndef f(:\n    pass\n", 3, "def f(:"), ("print 1\n\nx = 'a\n", 3, "x = 'a")],
)
def test_wrong_syntax_is_shown_where_it_is(text, line, shown):
    with pytest.raises(SyntaxError) as caught:
        run(text)
    assert (caught.value.filename, caught.value.lineno, caught.value.text) == ("old.py", line, shown)


# The command


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "old.py").write_text(
        "# -*- coding: latin-1 -*-\nfrom openravepy import *\nimport sys, helper, pkg.inside\n"
        "if not __openravepy_build_doc__:\n    env = Environment()\n"
        "print 3/2, helper.half(7), pkg.inside.VALUE, sys.argv, __name__\n"
        "if len(sys.argv) > 1:\n    helper.half(None)\nsys.exit(3)\n# \xe4\n",
        encoding="latin-1",
    )
    (tmp_path / "helper.py").write_text("def half(n):\n    print 'half',\n    return n / 2\n")
    (tmp_path / "pkg").mkdir()
    (tmp_path / "pkg" / "__init__.py").touch()
    (tmp_path / "pkg" / "inside.py").write_text("import beside\nVALUE = beside.VALUE / 2\n")
    (tmp_path / "pkg" / "beside.py").write_text("VALUE = 0x10L\n")
    return tmp_path


def test_run_translates_the_script_and_its_neighbours(folder):
    done = ravemj_command(folder, "run", "--py2", "old.py")
    assert (done.returncode, done.stdout) == (3, "half 1 3 8 ['old.py'] __main__\n")
    assert done.stderr == ""
    assert not list(folder.rglob("*.pyc"))


def test_run_shows_the_script_and_nothing_of_ours(folder):
    done = ravemj_command(folder, "run", "--py2", "old.py", "more")
    assert done.returncode == 1
    files = re.findall(r'File "(.*?)", line (\d+)', done.stderr)
    assert files == [("old.py", "8"), (str(folder / "helper.py"), "3")]
    assert "return n / 2\n" in done.stderr
    (folder / "helper.py").write_text("def f(:\n")
    done = ravemj_command(folder, "run", "--py2", "old.py")
    assert re.findall(r'File "(.*?)", line (\d+)', done.stderr) == [("old.py", "3"), (str(folder / "helper.py"), "1")]


def test_run_without_the_option_names_it(folder):
    done = ravemj_command(folder, "run", "old.py")
    assert done.returncode == 1
    assert done.stderr.endswith("\nravemj: old.py is Python 2; ravemj run --py2 old.py translates it\n")
    (folder / "new.py").write_text("import helper\n")
    done = ravemj_command(folder, "run", "new.py")
    assert done.stderr.splitlines()[-1].endswith("helper.py is Python 2; ravemj run --py2 new.py translates it")
    (folder / "wrong.py").write_text("def f(:\n")
    assert "--py2" not in ravemj_command(folder, "run", "wrong.py").stderr
