#!/bin/sh
# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
#
# check_isa_symbols.sh NM OBJECT...: fails when an object defines functions that
# other objects may define as well (weak symbols).

nm=$1
shift
symbols=$("$nm" -C --defined-only -A "$@") || exit 1
found=$(echo "$symbols" | grep -E ' [WVu] ' | grep -vE ' (typeinfo|vtable) |DW\.ref')
[ -z "$found" ] && exit 0
echo "Functions shared between instruction sets (give them internal linkage or inline them always):"
echo "$found"
exit 1
