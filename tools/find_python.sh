#!/bin/sh
# Prints the path of a Python of exactly the version asked for that can make virtual environments.
# Usage: find_python.sh 3.11 [CANDIDATE]; a CANDIDATE, when given, is the only one tried.
set -u
version=$1
candidate=${2:-}

path_of() { # really runs it: a launcher on PATH may point at a Python that is not there
    "$1" -c "
import sys, ensurepip, venv
if '%d.%d' % sys.version_info[:2] != '$version': sys.exit(1)
print(sys.executable)" 2>/dev/null
}

if [ -n "$candidate" ]; then
    path_of "$candidate" && exit 0
    echo "PYTHON=$candidate is no Python $version with the module venv: name one, as in PYTHON=/usr/bin/python$version." >&2
    exit 1
fi
for name in "python$version" python3 python "${PYENV_ROOT:-${HOME:-}/.pyenv}"/versions/"$version".*/bin/python; do
    path_of "$name" && exit 0
done
echo "No Python $version with the module venv was found: install one (on Debian: python$version python$version-venv) or name it in PYTHON." >&2
exit 1
