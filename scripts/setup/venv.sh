# shellcheck shell=sh disable=SC2154
# Makes .venv and keeps it up to date. The scripts set `root`, source this, and call `ready LOCK`.
#
#   .venv/made        where and with which Python .venv was made; missing while anything is installed
#   .venv/ready-LOCK  the lock file and project file that were installed, written last

venv=$root/.venv
python=$venv/bin/python
work= # a temporary folder, while .venv is made
unset PYTHONPATH PYTHONHOME # ROS sets them, and they would reach into .venv
export PIP_DISABLE_PIP_VERSION_CHECK=1 PIP_USER=0

say() { echo "${0##*/}: $*" >&2; }

fail() {
    say "$*"
    [ -z "$work" ] || [ -s "$log" ] || rm -rf "$work"
    exit 1
}

# ready LOCK: see to it that .venv has what scripts/locks/LOCK.txt lists, and ravemj itself.
ready() {
    lock=$root/scripts/locks/$1.txt
    content=$(cat "$lock" "$root/pyproject.toml" | cksum)
    if usable && [ "$(cat "$venv/ready-$1" 2>/dev/null)" = "$content" ]; then
        return
    fi
    work=$(mktemp -d "${TMPDIR:-/tmp}/ravemj.XXXXXX" 2>/dev/null) || fail "cannot make a temporary folder"
    log=$work/log
    trap 'rm -rf "$work"; exit 130' INT TERM
    usable || make_venv
    install_lock
    echo "$content" >"$venv/ready-$1"
    rm -rf "$work"
    trap - INT TERM
}

# .venv was made here and in full, its Python still is what it was, and it is the one asked for.
usable() {
    version=$(version_of "$python") && [ "$(cat "$venv/made" 2>/dev/null)" = "$root $version" ] &&
        { [ -z "${PYTHON:-}" ] || [ "$(version_of "$PYTHON")" = "$version" ]; }
}

version_of() { "$1" -c 'import sys; print("%d.%d" % sys.version_info[:2])' 2>/dev/null; }

make_venv() {
    find_base
    say "making .venv with $base"
    for way in with_ensurepip with_own_pip with_uv with_apt; do
        rm -rf "$venv" 2>>"$log" || fail "cannot remove the old $venv; remove it, and try again"
        echo "== $way" >>"$log"
        if "$way" >>"$log" 2>&1; then
            return
        fi
    done
    mkdir -p "$venv" 2>/dev/null || fail "cannot write to $root"
    fail "cannot make .venv, as $base has no ensurepip; try: sudo apt-get install python$version-venv (log: $log)"
}

# Set `base` to the interpreter that .venv is made with: never one that lies in a virtual environment.
find_base() {
    for base in "${PYTHON:-python3}" python3.14 python3.13 python3.12 python3.11; do
        if "$base" -c 'import sys; sys.exit(sys.version_info < (3, 11))' >/dev/null 2>&1; then
            version=$(version_of "$base")
            base=$("$base" -c 'import sys; print(sys._base_executable)')
            return
        fi
        [ -z "${PYTHON:-}" ] || fail "PYTHON=$PYTHON is not Python 3.11 or newer"
    done
    fail "no Python 3.11 or newer is on PATH; install one, or name it: PYTHON=/path/to/python $0"
}

# Four ways to a virtual environment with pip in it. Debian's python3 lacks ensurepip without python3-venv.
with_ensurepip() { "$base" -m venv "$venv"; }

with_own_pip() { "$base" -m venv --without-pip "$venv" && "$base" -m pip --python "$python" install pip; }

with_uv() { uv venv --seed --python "$base" "$venv"; }

with_apt() {
    mkdir -p "$work/lists/partial" "$work/cache/archives/partial"
    set -- -o "Dir::State::Lists=$work/lists" -o "Dir::Cache=$work/cache" -o APT::Sandbox::User=
    (cd "$work" && apt-get "$@" -q update && apt-get "$@" -q download python3-pip-whl && dpkg-deb -x ./*.deb .) ||
        return
    for wheel in "$work"/usr/share/python-wheels/pip-*.whl; do
        "$base" -m venv --without-pip "$venv" && "$python" "$wheel/pip" install --no-index "$wheel"
        return
    done
}

install_lock() {
    say "installing the packages of ${lock#"$root/"}; the first time takes a minute or two"
    rm -f "$venv/made"
    status=0
    { pip_install --require-hashes --only-binary :all: --requirement "$lock" &&
        pip_install --no-index --no-deps --no-build-isolation --editable "$root"; } || status=$?
    [ "$status" -gt 128 ] || echo "$root $version" >"$venv/made" # pip was not killed: no package is half there
    if [ "$status" != 0 ]; then
        reason=$(sed -n 's/^ERROR: //p' "$log" | tail -n 1)
        ! grep -q 'connection broken' "$log" || reason="no connection to the package index"
        fail "cannot install the packages: ${reason:-pip was stopped} (log: $log)"
    fi
}

pip_install() { "$python" -m pip install --quiet "$@" >>"$log" 2>&1; }
