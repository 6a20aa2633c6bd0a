"""Scripts written for Python 2: what they mean, where their errors are, and how ``ravemj run --py2`` runs them.

What is expected of them is what Python 2.7.18 and NumPy 1.13.3 gave.
"""

import collections
import os
import re
import shutil
import subprocess
import sys
import time
import traceback
from fractions import Fraction
from pathlib import Path
from typing import Any

import fissix
import numpy as np
import pytest
from command_line import ravemj_command
from hypothesis import given
from hypothesis import strategies as st

from ravemj.compat import openravepy, python2
from ravemj.compat.python2.division import divide
from ravemj.compat.python2.translation import FIXERS


def run(source: str, path: str = "old.py") -> dict[str, Any]:
    space: dict[str, Any] = {"__name__": "__main__"}
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
        ("numpy.tile(3, numpy.floor(2.5))", [3, 3]),
        ("numpy.tile([1], (2., 2)).tolist() + numpy.ones((1., 2)).tolist()", [[1, 1]] * 3),
        ("numpy.reshape(numpy.repeat([1, 2], 2.), (2., -1))", [[1, 1], [2, 2]]),
        ("numpy.zeros(shape=2.)", [0, 0]),
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
        ("iter(['a']).next().upper()", "A"),
        ("[x + y for x in 1, 2 for y in 3, 4]", [4, 5, 5, 6]),
        ("077777777777777777L", 2251799813685247),
        ("map(None, [1, 2], [3]) == [(1, 3), (2, None)]", True),
        ("map(None, [1, 2])", [1, 2]),
        ("map(max, [1, 5], [2, 3])", [2, 5]),
        ("filter(lambda c: c != 'a', 'abc') + str(filter(None, (0, 1)))", "bc(1,)"),
        ("[round(x) for x in (0.5, 2.5, -2.5, -0.4)]", [1.0, 3.0, -3.0, -0.0]),
        ("[round(2.675, 2), round(0.125, 2), round(125, -1), round(1e300)]", [2.67, 0.13, 130.0, 1e300]),
        ("[round(numpy.array([2.5])), round(float('inf'))]", [3.0, float("inf")]),
        ("math.floor(5) / 2 + math.ceil(7.5) / 2 + numpy.math.floor(3) / 2", 2.5 + 4 + 1.5),
        ("sorted([3, 1, 2], cmp=lambda a, b: b - a) + sorted([3, 1, 2], lambda a, b: a - b)", [3, 2, 1, 1, 2, 3]),
        ("sorted([(1, 2), (0, 3)], lambda a, b: b - a, lambda t: t[1], True)", [[1, 2], [0, 3]]),
        ("sorted([3, 1], reverse=True)", [3, 1]),
        ("apply(max, (1, 5)) + reduce(max, [1, 7]) + ord(unichr(65)) + len(intern('ab'))", 5 + 7 + 65 + 2),
        ("eval('7 / 2') + eval(' 010') + eval(compile('9 / 2', 'name', 'eval'))", 3 + 8 + 4),
        ("{1: 2}.items()[0] + tuple({3: 4}.iterkeys())", (1, 2, 3)),
        ("{1: 2}.itervalues().next() + len({1: 2}.viewkeys())", 3),
        ("'%s' % u'\xe4'.encode('utf-8') + str.decode('a') + '\xe4'.encode('latin-1').decode('latin-1')", "\xe4a\xe4"),
        ("'a'.decode('utf-8') + numpy.array([97], numpy.uint8).tostring().decode()", "aa"),
        ("float(numpy.array([2.5])) + int(numpy.array([[3]])) + math.sqrt(numpy.array([4.0]))", 7.5),
        ("(lambda x, (a, b): x + a * b)(1, (2, 3))", 7),
        ("(lambda (a, (b, c)), d=4: [a, b, c, d])((1, (2, 3)))", [1, 2, 3, 4]),
        ("(lambda (a, b)=(1, 2), *r, **k: a + b + len(r) + len(k))((3, 4), 5, z=6)", 9),
        ("(lambda (a, b), (c, d): Fraction(7).numerator + a + d)((1, 2), [3, 4])", 12),
        ("(lambda (a): a)(5)", 5),
        ("reduce(lambda x, (a, b): x + a * b, [(1, 2), (3, 4)], 0)", 14),
    ],
)
def test_expressions_mean_what_they_did(expression, value):
    text = f"import math, numpy, string\nfrom fractions import Fraction\nresult = {expression}\n"
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
        ("def f((a, (b, c))=(1, (2, 3)), *d): return [a, b, c]\nx = f() + f((4, (5, 6)))", [1, 2, 3, 4, 5, 6]),
        ("class A:\n    def f(self, (a, __b)):\n        if a: return __b\nx = A().f((1, 2))", 2),
        ("def f((a, b)):\n    def g((c, d)): return a + d\n    return g\nx = f((1, 2))((3, 4))", 5),
        ("exec 'x = 7 / 2'", 3),
        ("exec 'y = [2, 1]; y.sort(cmp)' in globals()\nx = y", [1, 2]),
        ("exec compile('x = 7 / 2', 'name', 'exec')", 3),
        ("def f(y): return eval('y / 2')\nx = f(7)", 3),
        ("x = [3, 1, 2]; x.sort(lambda a, b: b - a)", [3, 2, 1]),
        ("x = [3, 1, 2]; x.sort(None, lambda a: -a)", [3, 2, 1]),
        ("x = [3, 1, 2]; x.sort(None, None, True)", [3, 2, 1]),
        ("x = numpy.array([[3, 1], [2, 0]]); x.sort(0)", [[2, 0], [3, 1]]),
        ("class A:\n    def sort(self, x): return x\nx = A().sort(5)", 5),
        ("try: raise KeyError('m')\nexcept KeyError,e: pass\nx = e.message + repr(e.args)", "m('m',)"),
        ("try: raise IOError(2, 'm')\nexcept IOError, (number, text): x = number", 2),
        ("class A: pass\na = A()\ntry: [][1]\nexcept IndexError, a.e: x = a.e.__class__.__name__", "IndexError"),
        ("class A: message = 'own'\nx = A().message", "own"),
        ("import sys\ntry: raise KeyError\nexcept: x = sys.exc_type.__name__", "KeyError"),
        ("y = numpy.zeros(2)\nx = [y == None, None != y, y is None, None == None]", [False, True, False, True]),
        ("class A:\n    def __iter__(self): return self\n    def next(self): raise StopIteration\nx = list(A())", []),
        ("class A:\n    def next(self): return self\n    def real(self): return 3\nx = A().next().next().real()", 3),
        ("class A:\n    def has_key(self, k): return k\nx = A().has_key(5)", 5),
        ("class A(dict):\n    def keys(self): return 'own'\nx = A().keys()", "own"),
        ("class A:\n    def __nonzero__(self): return False\nx = bool(A())", False),
        ("try: raise Exception\nexcept StandardError: x = 3", 3),
        ("x = 'a\\d'", "a\\d"),
        ("x = 2\nglobal x\ndef f():\n    'doc'\n    print x\n    global x\n    x = 3\nf()", 3),
        ("class A:\n    global x\n    x = 4", 4),
        (
            "def f():\n    from math import *\n    from numpy import *\n    return product([ceil(1.5), 0.25])\nx = f()",
            0.5,
        ),
    ],
)
def test_statements_do_what_they_did(statements, value):
    assert np.asarray(run(f"import numpy\n{statements}\n")["x"]).tolist() == value


ORDER = """
class A:
    def __init__(self, key): self.key = key
    def __cmp__(self, other): return cmp(self.key, other.key)
class B(object):
    def __eq__(self, other): return True
class C: pass
smallest = min([A(3), A(1), A(2)]).key
comparisons = [A(1) == A(1), A(1) != A(1), A(1) < A(2), A(2) >= A(3), cmp(A(2), A(1))]
hashed = [len(set([A(1)])), len(set([B()])), B() == 5]
some = sorted([(1, C()), (1, C())], reverse=True)
class D(str): pass
names = sorted([D("b"), D("a")])
"""


def test_objects_are_ordered_and_have_hashes():
    space = run(ORDER)
    assert (space["smallest"], space["comparisons"]) == (1, [True, False, True, False, 1])
    assert (space["hashed"], len(space["some"]), space["names"]) == ([1, 1, True], 2, ["a", "b"])


def test_printing(capsys):
    run("import sys\nprint 'a',\nprint 'b', 3\nprint\nprint('c')\nprint >>sys.stderr, 'd'\n")
    assert capsys.readouterr() == ("a b 3\n\nc\n", "d\n")


@pytest.mark.parametrize("names", ["print_function, division", "(print_function,\n    division)"])
def test_files_that_ask_for_true_division_get_it(names):
    assert run(f"from __future__ import {names}\nprint(1, end='')\nx = 3 / 2\n")["x"] == 1.5


def test_what_only_python_3_understands_is_taken_as_it_is():
    assert run("match 3:\n    case y:\n        x = y / 2 + isinstance(map(abs, []), list)\n")["x"] == 1.5


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


# Names of modules


NUMPY = r"""
from math import *
from openravepy import *
import numpy.linalg, numpy as np
from numpy import *
from numpy import mat as matrix_of, float_, math as m
smallest = min([3, 1], key=lambda x: -x), max(1, 2), abs(-3), pow(2, 3), isinstance(True, bool)
kinds = [type(x).__name__ for x in (pow(2, 2), acos(0), atan2(0, 1), round(2))]
total = sum(x for x in (1, 2)), list(sum(ones((2, 2)), 0)), any([0, 1]), all([1])
product_of = (mat('1 2; 3 4') * np.mat([[1], [1]])).tolist(), matrix_of([1]).shape, np.linalg.norm([3, 4]), math.pi
constants = Inf, NaN, infty, PINF, NINF, numpy.Inf, -numpy.NZERO
types = np.float is float, np.int, np.bool, np.object, np.long, np.str, float_, complex_, bool8
functions = [
    asscalar(array([3])), product([2, 3]), list(cumproduct([2, 3])), alltrue([1, 0]), sometrue([1, 0]),
    list(in1d([1, 2], [2])), trapz([1, 2]), list(asfarray([1, 2])), rank([[1]]), row_stack(([1], [2])).tolist(),
    msort([[3], [1]]).tolist(), alen([1, 2]), round_(2.5), list(np.find_common_type([float32], [int64]).name),
    list(array([1, 2], copy=False)), array([[1], [2, 3]]).dtype.kind, list(fromstring('\x01\x00', uint8)),
    list(fromstring('1 2', sep=' ')), list(floor([3, 5]) / 2), divide(7, 2), ceil(5) / 2, arange(4).ptp()
]
"""
NUMPY_GAVE = {
    "smallest": (3, 2, 3, 8, True),
    "kinds": ["float", "float", "float", "float"],
    "total": (3, [2, 2], True, True),
    "product_of": ([[3], [7]], (1, 1), 5, np.pi),
    "types": (True, int, bool, object, int, str, np.float64, np.complex128, np.bool_),
    "functions": [
        *(3, 6, [2, 6], False, True, [False, True], 1.5, [1, 2], 2, [[1], [2]], [[1], [3]], 2, 2, list("float32")),
        *([1, 2], "O", [1, 0], [1, 2], [1.5, 2.5], 3, 2.5, 3),
    ],
}


@pytest.mark.filterwarnings("ignore::PendingDeprecationWarning")  # of matrices
def test_numpy_has_the_names_of_its_first_version(monkeypatch):
    monkeypatch.setitem(sys.modules, "openravepy", openravepy)
    before = set(dir(np)), np.floor, np.sum
    space = run(NUMPY)
    assert {name: space[name] for name in NUMPY_GAVE} == NUMPY_GAVE
    infinity, nan, *infinities, zero = space["constants"]
    assert np.isnan(nan)
    assert [infinity, *infinities, zero] == [np.inf, np.inf, np.inf, -np.inf, np.inf, 0]
    assert (set(dir(np)), np.floor, np.sum) == before


LIBRARY = r"""
import collections, fractions, inspect, itertools, operator, os, string, sys, threading, time, types, platform, urllib
import cPickle, StringIO, Queue, ConfigParser, commands, exceptions, sets, urllib2, urlparse, thread, __builtin__
import xml.etree.cElementTree as ET, md5, imp
from xml.etree import cElementTree
from collections import Iterable, Mapping as AnyMapping, deque
from itertools import izip, imap, ifilter, count, izip_longest as longest
from string import letters, maketrans, join
from time import clock, sleep
from sys import maxint
def f(a, b=2, *c, **d): pass
spec = inspect.getargspec(f)
def visit(found, folder, names):
    found.append((os.path.basename(folder), sorted(names)))
    names[:] = [name for name in names if name != "skip"]
reload(sys); sys.setdefaultencoding("utf-8"); sys.setcheckinterval(10); sys.exc_clear()
thread_ = threading.Thread(target=f, args=(1,)); thread_.start(); thread_.join()
buffer_ = StringIO.StringIO(); print >>buffer_, "a", 3
parser = ConfigParser.ConfigParser(); parser.readfp(StringIO.StringIO("[a]\nb: c"))
__builtin__.answer = 42
class Walked: found = []
os.path.walk(os.curdir, visit, Walked.found)
result = [
    time.clock() > 0, clock() > 0, isinstance([], collections.Iterable), issubclass(dict, AnyMapping),
    collections.OrderedDict([(1, 2)]).keys(), fractions.gcd(12, 18), list(itertools.izip([1], [2])),
    [x for x, y in izip("ab", count())], imap(abs, count()).next(), list(ifilter(None, [0, 1])), list(longest([1], [])),
    string.letters[25:27] + letters[:1], string.join(["a", "b"]) + join("ab", "-"), string.split("a,b", ","),
    string.atoi("12"), string.upper("a"), "abc".translate(maketrans("ab", "xy")), os.getcwdu() == os.getcwd(),
    os.errno.ENOENT, sys.maxint == maxint == 2 ** 63 - 1, list(spec), spec.defaults, types.StringType is str,
    isinstance("a", types.StringTypes), type(None) == types.NoneType, operator.div(7, 2), operator.isCallable(f),
    thread_.isAlive(), thread.allocate_lock().locked(), buffer_.getvalue(), parser.get("a", "b"), Queue.Queue().empty(),
    cPickle.loads(cPickle.dumps([1])), commands.getoutput("echo a"), exceptions.ValueError is ValueError, answer,
    sorted(sets.Set([2, 1])), urllib.quote("a b"), urllib2.quote("a b"), urlparse.urlparse("http://a/b").netloc,
    ET.fromstring("<a><b/></a>").getchildren()[0].tag, cElementTree is ET, len(platform.dist()), md5.new().name,
    imp.new_module("a").__name__, os.path.join("a", "b") == "a" + os.sep + "b", sys.stdout is __import__("sys").stdout,
]
sys.ravemj_test = 3
"""
LIBRARY_GAVE = [
    *(True, True, True, True, [1], 6, [(1, 2)], ["a", "b"], 0, [1], [(1, None)]),
    *("zAa", "a ba-b", ["a", "b"], 12, "A", "xyc", True, 2, True, [["a", "b"], "c", "d", (2,)], (2,), True, True),
    *(True, 3, True, False, False, "a 3\n", "c", True, [1], "a", True, 42, [1, 2], "a%20b", "a%20b", "a"),
    *("b", True, 3, "md5", "a", True, True),
]


@pytest.mark.filterwarnings("ignore:This method will be removed:DeprecationWarning")  # readfp, until it is
def test_the_standard_library_has_its_older_names(tmp_path, monkeypatch):
    (tmp_path / "skip").mkdir()
    (tmp_path / "skip" / "file").touch()
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(sys, "ravemj_test", 0, raising=False)
    space = run(LIBRARY)
    assert space["result"] == LIBRARY_GAVE
    assert space["Walked"].found == [(".", ["skip"])]
    assert vars(sys)["ravemj_test"] == 3  # what scripts set, they set
    assert not any(
        hasattr(module, name) for module, name in ((time, "clock"), (collections, "Iterable"), (sys, "maxint"))
    )
    assert "cPickle" not in sys.modules


# Files


FILES = """
import codecs, csv, hashlib, json, numpy, pickle, struct, subprocess, sys
writer = csv.writer(open("a.csv", "wb")); writer.writerow([1, "b,c"]); writer.writerow(["d", 2.5]); del writer
rows = list(csv.reader(open("a.csv", "rb")))
table = list(csv.DictReader(open("a.csv", "rb")))
lines = [line for line in open("a.csv", "rb")], open("a.csv", "rU").readlines(), file("a.csv").xreadlines().next()
raw = open("a.csv").read()
with open("a.txt", "w") as f:
    f.write("a\\n"); f.writelines(["b\\n", u"c\\n"])
    print >>f, "d", 4
    try: f.write(5)
    except TypeError: pass
text = open("a.txt").read(), open("a.txt").read(2), isinstance(f, file), f.closed, f.name, f.mode
f = open("a.txt", "r+"); f.readline(); f.seek(-4, 2); end = f.read(), f.tell(); f.close()
for mode in "w", "wb":
    f = open("a.pickle", mode); pickle.dump({"a": [1, 2.5]}, f, 2); f.write(pickle.dumps("b")); f.close()
    f = open("a.pickle", "r"); pickled = [pickle.load(f), pickle.Unpickler(f).load()]
f = open("a.pickle"); pickle.dump(3, open("b.pickle", "w")); loaded = pickle.loads(open("b.pickle", "rb").read())
f = open("a.bin", "wb"); f.write(struct.pack("<i", 258)); f.write("\\x01"); f.close()
f = open("a.bin", "rb"); binary = struct.unpack("<i", f.read(4)), f.read()
f = open("a.npy", "wb"); numpy.save(f, numpy.arange(3)); f.close()
f = open("b.bin", "wb"); numpy.arange(3).tofile(f); f.close()
arrays = [numpy.load(open("a.npy", "rb")).tolist(), numpy.fromfile(open("b.bin", "rb"), int).tolist()]
f = open("b.txt", "w"); numpy.savetxt(f, [[1, 2]]); f.close(); arrays.append(numpy.loadtxt(open("b.txt")).tolist())
json.dump({"a": 1}, open("a.json", "w")); read_json = json.load(open("a.json", "rb"))
log = open("a.log", "w", 0); log.write("now"); logged = open("a.log").read(); log.close()
old = sys.stdout; sys.stdout = open("out", "w"); print "caught"; sys.stdout.close(); sys.stdout = old
f = open("sub", "w"); subprocess.call([sys.executable, "-c", "print(5)"], stdout=f); f.close()
others = open("out").read(), open("sub").read()
answer = subprocess.check_output([sys.executable, "-c", "print(7)"]).split("\\n")[0]
p = subprocess.Popen([sys.executable, "-c", "print(input())"], stdin=subprocess.PIPE, stdout=subprocess.PIPE)
answers = [answer, p.communicate("8\\n")[0].strip(), hashlib.md5("a").hexdigest()[:4]]
stream = codecs.getwriter("utf-8")(sys.stdout); stream.write(u"written\\n")
latin = open("latin", "wb"); latin.write(bytearray([228, 10])); latin.close()
copy = open("copy", "w"); copy.write(open("latin").read()); copy.close(); same = open("copy", "rb").read()
with open("latin", encoding="latin-1") as f: asked = f.read()  # as only Python 3 can be asked
"""


def test_files_take_and_give_text_and_bytes(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    space = run(FILES)
    assert space["rows"] == [["1", "b,c"], ["d", "2.5"]]
    assert space["table"] == [{"1": "d", "b,c": "2.5"}]
    assert space["raw"] == '1,"b,c"\r\nd,2.5\r\n'
    binary_lines, universal_lines, first = space["lines"]
    assert (binary_lines, first) == (['1,"b,c"\r\n', "d,2.5\r\n"], '1,"b,c"\r\n')
    assert universal_lines == ['1,"b,c"\n', "d,2.5\n"]
    assert space["text"] == ("a\nb\nc\nd 4\n", "a\n", True, True, "a.txt", "w")
    assert space["end"] == ("d 4\n", 10)
    assert (space["pickled"], space["loaded"]) == ([{"a": [1, 2.5]}, "b"], 3)
    assert space["binary"] == ((258,), b"\1")
    assert space["arrays"] == [[0, 1, 2], [0, 1, 2], [1, 2]]
    assert (space["read_json"], space["logged"]) == ({"a": 1}, "now")
    assert space["others"] == ("caught\n", "5" + os.linesep)
    assert space["answers"] == ["7", "8", "0cc1"]
    assert (space["same"], space["asked"]) == (b"\xe4\n", "\xe4\n")


def test_trajectories_are_stored_as_text(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    space = run("""
from ravemj import *
trajectory = RaveCreateTrajectory(Environment(), '')
spec = ConfigurationSpecification(); spec.AddGroup('deltatime', 1, 'linear')
trajectory.Init(spec); trajectory.Insert(0, [0.5])
text = '<x>%s</x>' % trajectory.serialize(0)
f = open('motion', 'w'); f.write(trajectory.serialize()); f.close()
same = RaveCreateTrajectory(Environment(), '').deserialize(open('motion').read()).GetWaypoint(0)
""")
    assert space["text"].startswith("<x><trajectory")
    assert space["same"] == [0.5]


def test_arrays_that_python_2_pickled_can_be_read(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    pickled = (
        b"cnumpy.core.multiarray\n_reconstruct\np0\n(cnumpy\nndarray\np1\n(I0\ntp2\nS'b'\np3\ntp4\nRp5\n(I1\n(I1\ntp6\n"
        b"cnumpy\ndtype\np7\n(S'f8'\np8\nI0\nI1\ntp9\nRp10\n(I3\nS'<'\np11\nNNNI-1\nI-1\nI0\ntp12\nbI00\n"
        b"S'\\x00\\x00\\x00\\x00\\x00\\x00\\xf8?'\np13\ntp14\nb."
    )
    (tmp_path / "old.pickle").write_bytes(pickled)
    assert run("import cPickle\nx = cPickle.load(open('old.pickle'))\n")["x"].tolist() == [1.5]


# Imports


@pytest.fixture
def script_folder(tmp_path, monkeypatch):
    """A folder whose modules are those of a script that runs."""
    folder = tmp_path / "script"
    folder.mkdir()
    monkeypatch.setattr(sys, "dont_write_bytecode", False)
    monkeypatch.setattr(sys, "meta_path", [*sys.meta_path])
    monkeypatch.setattr(sys, "path", [str(folder), str(tmp_path / "library"), *sys.path])
    yield folder
    for name, module in list(sys.modules.items()):
        if (getattr(module, "__file__", None) or "").startswith(str(tmp_path)):
            del sys.modules[name]


def write(folder, **texts):
    folder.mkdir(exist_ok=True)
    for name, text in texts.items():
        (folder / f"{name}.py").write_text(text)


def test_a_script_is_no_package_whatever_lies_beside_it(script_folder):
    write(script_folder, __init__="", beside="HALF = 7 / 2\n")
    python2.install_finder(str(script_folder))
    space = run("from beside import HALF\nimport beside\n", str(script_folder / "main.py"))
    assert (space["HALF"], space["beside"].__name__) == (3, "beside")


def test_modules_of_a_package_find_their_neighbours_first(script_folder):
    deep = script_folder / "package" / "deep"
    write(script_folder, json="WHERE = 'beside the script'\n")
    write(script_folder / "package", __init__="", string="WHERE = 'in the package'\n")
    write(
        script_folder / "package",
        inner="import string, deep.lowest, json\nfrom string import *\nfrom deep.lowest import UP\n",
        absolute="from __future__ import absolute_import\nimport string\nfound = string.letters[:2]\n",
    )
    write(deep, __init__="", lowest="from .. import string\nfrom ..string import WHERE as UP\n")
    python2.install_finder(str(script_folder))
    space = run("from package import inner, absolute\nimport package.inner\n")
    assert (space["inner"].string.WHERE, space["inner"].WHERE, space["inner"].UP) == ("in the package",) * 3
    assert space["inner"].deep.lowest.string.__name__ == "package.string"
    assert space["inner"].json.__name__ == "json"
    assert space["absolute"].found == "ab"


def test_modules_of_the_path_are_translated_where_python_3_does_not_read_them(script_folder):
    library, added = script_folder.parent / "library", script_folder.parent / "added"
    write(library, both="HALF = 7 / 2\n", old="print 'old',\nHALF = 7 / 2\n", new="HALF = f'{7 / 2}'\n")
    write(
        library / "pack",
        __init__="HALF = 7 / 2\n",
        other="import first\nHALF = first.HALF\n",
        first="HALF = 0777 / 2\n",
    )
    write(added, late="HALF = 7 / 2\n")
    python2.install_finder(str(script_folder))
    sys.path.append(str(added))
    space = run("import both, old, new, pack.other, late\n")
    halves = [space[name].HALF for name in ("both", "old", "new", "pack", "late")]
    assert halves == [3.5, 3, "3.5", 3, 3]
    assert space["pack"].other.HALF == 255
    kept = {path.name.split(".")[0] for path in script_folder.parent.rglob("*.pyc")}
    assert kept == {"both", "new"}  # Python 3 would take byte code of the others for its own


# The command


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "old.py").write_text(
        "# -*- coding: latin-1 -*-\nfrom openravepy import *\nimport sys, helper, pkg.inside\n"
        "if not __openravepy_build_doc__:\n    env = Environment()\n"
        "print 3/2, helper.half(7), pkg.inside.VALUE, sys.argv, __name__, [numpy.float_(2) * numpy.mat(1)[0, 0]]\n"
        "if len(sys.argv) > 1:\n    try: import nothing\n    except ImportError: helper.half(None)\n"
        "sys.exit(3)\n# \xe4\n",
        encoding="latin-1",
    )
    (tmp_path / "__init__.py").touch()
    (tmp_path / "helper.py").write_text("def half(n):\n    print 'half',\n    return n / 2\n")
    (tmp_path / "pkg").mkdir()
    (tmp_path / "pkg" / "__init__.py").touch()
    (tmp_path / "pkg" / "inside.py").write_text("import beside\nVALUE = beside.VALUE / 2\n")
    (tmp_path / "pkg" / "beside.py").write_text("VALUE = 0x10L\n")
    return tmp_path


def test_run_translates_the_script_and_its_neighbours(folder):
    done = ravemj_command(folder, "run", "--py2", "old.py")
    assert (done.returncode, done.stdout) == (3, "half 1 3 8 ['old.py'] __main__ [2.0]\n")
    assert done.stderr == ""
    assert not list(folder.rglob("*.pyc"))


def test_run_shows_the_script_and_nothing_of_ours(folder):
    done = ravemj_command(folder, "run", "--py2", "old.py", "more")
    assert done.returncode == 1
    files = re.findall(r'File "(.*?)", line (\d+)', done.stderr)
    assert files == [("old.py", "8"), ("old.py", "9"), (str(folder / "helper.py"), "3")]  # one, and one on the way
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
    (folder / "new.py").write_text("print(len(raw_input('')))\n")
    done = ravemj_command(folder, "run", "new.py")
    assert done.stderr.splitlines()[-1] == "ravemj: Python 2 has raw_input; ravemj run --py2 new.py knows its names"
    (folder / "new.py").write_text("print(unknown)\n")
    assert "--py2" not in ravemj_command(folder, "run", "new.py").stderr
    (folder / "wrong.py").write_text("def f(:\n")
    assert "--py2" not in ravemj_command(folder, "run", "wrong.py").stderr


def newest_python():
    """The newest Python that is installed, at least the one that runs."""
    for minor in range(sys.version_info.minor + 9, sys.version_info.minor, -1):
        found = shutil.which(f"python3.{minor}")
        if found and not subprocess.run([found, "-c", ""], capture_output=True, check=False).returncode:
            return found
    return sys.executable


def test_scripts_are_translated_on_the_newest_python(tmp_path):
    """fissix, whose last release is of 2024, works there: alone, since the packages of ravemj are for this Python."""
    for name in ("fissix", "appdirs.py"):
        source = Path(fissix.__file__).parent.parent / name
        if source.exists():
            (tmp_path / name).symlink_to(source)
    code = (
        "import sys; from fissix.refactor import RefactoringTool; fixes, text = sys.argv[1:]; "
        "tool = RefactoringTool(['fissix.fixes.fix_' + name for name in fixes.split()]); "
        "done = str(tool.refactor_string(text, 'script')); compile(done, 'script', 'exec'); print(done)"
    )
    script = "try:\n    print 'two', 0777 <> 1\nexcept KeyError, error:\n    raise ValueError, `error`\n"
    command = [newest_python(), "-W", "ignore", "-c", code, FIXERS + " except numliterals", script]
    environment = {**os.environ, "PYTHONPATH": str(tmp_path)}
    done = subprocess.run(command, capture_output=True, text=True, check=True, env=environment, cwd=tmp_path)
    assert done.stdout.splitlines()[1] == "    print('two', 0o777 != 1)"
