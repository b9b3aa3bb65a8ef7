#!/usr/bin/env python3
# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
"""Curves from tables of the command mpm_point.

usage: plot_point.py [-x COLUMN] [-y COLUMN] [-o FILE] [--labels TEXT,...] TABLE...

COLUMN is a column of the table, or a formula of columns, such as exx, -pressure, sxx/1e6,
or sqrt(sxy**2); default: vonmises over exx, or over exy where exx stays zero. Without -o
the picture is shown on the screen."""
import argparse
import os

import numpy as np


def read(path):
    """columns by name, and the comment lines"""
    comments = []
    with open(path) as file:
        for line in file:
            if not line.startswith("#"):
                names = line.split()
                break
            comments.append(line[1:].strip())
        else:
            raise SystemExit("%s: no table of mpm_point" % path)
        values = np.loadtxt(file, ndmin=2)
    if values.shape[1] != len(names):
        raise SystemExit("%s: rows do not match the names of the columns" % path)
    return {name: values[:, k] for k, name in enumerate(names)}, comments


def evaluate(formula, table):
    """A column, or a formula of columns."""
    if formula in table:
        return table[formula]
    functions = {name: getattr(np, name) for name in ("sqrt", "exp", "log", "abs", "sin", "cos")}
    names = {name: values for name, values in table.items() if name.isidentifier()}
    try:
        return eval(formula, {"__builtins__": {}}, dict(functions, **names)) + 0 * table["step"]
    except (NameError, SyntaxError) as problem:
        raise SystemExit("%s: %s; columns are %s" % (formula, problem, ", ".join(table)))


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("tables", nargs="+", metavar="TABLE")
    parser.add_argument("-x", help="column or formula of the axis to the right")
    parser.add_argument("-y", default="vonmises", help="column or formula of the axis upwards")
    parser.add_argument("-o", metavar="FILE", help="picture to write")
    parser.add_argument("--labels", help="names of the curves, separated by commas")
    parser.add_argument("--xlabel", help="text at the axis to the right")
    parser.add_argument("--ylabel", help="text at the axis upwards")
    parser.add_argument("--title", default="")
    options = parser.parse_args()

    import matplotlib
    if options.o:
        matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    labels = options.labels.split(",") if options.labels else [
        os.path.splitext(os.path.basename(path))[0] for path in options.tables]
    if len(labels) != len(options.tables):
        raise SystemExit("%d labels for %d tables" % (len(labels), len(options.tables)))
    figure, axes = plt.subplots(figsize=(6, 4.2), dpi=120)
    for path, label in zip(options.tables, labels):
        table, _ = read(path)
        x = options.x or ("exx" if np.any(table["exx"]) else "exy")
        axes.plot(evaluate(x, table), evaluate(options.y, table), label=label)
    axes.set_xlabel(options.xlabel or x)
    axes.set_ylabel(options.ylabel or options.y)
    axes.set_title(options.title)
    axes.grid(alpha=0.3)
    if len(labels) > 1:
        axes.legend(fontsize="small")
    figure.tight_layout()
    if options.o:
        figure.savefig(options.o)
    else:
        plt.show()


main()
