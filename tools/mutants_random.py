# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
"""Small mistakes at random places of src/MPM, for tools/mutate.py --random: all of them in one copy of the sources, each
of which is made while the program runs, when the environment variable MPM_MUTANT has its number."""

import glob
import os
import random
import re

OPERAND = r"[\w.]+(?:->\w+|::\w+|\[[^\[\]]*\])*"


def scaled(factor):
    return lambda found: repr(float(found.group()) * factor)


def swapped(*pairs):
    return lambda found: dict(pairs)[found.group()]


# name, what is replaced, and by what
CHANGES = [
    ("sign", r"(?<=[\w)\]]) [+-] (?=[\w(*&])", swapped((" + ", " - "), (" - ", " + "))),
    ("sign", r"(?<= )[+-]=(?= )", swapped(("+=", "-="), ("-=", "+="))),
    ("twice", r"(?<![\w.\[-])\d+\.\d+(?:e[+-]?\d+)?(?![\w.])", scaled(2.0)),
    ("2 % more", r"(?<![\w.\[-])\d+\.\d+(?:e[+-]?\d+)?(?![\w.])", scaled(1.02)),
    ("comparison", r" (?:<|<=|>|>=) ", swapped((" < ", " <= "), (" <= ", " < "), (" > ", " >= "), (" >= ", " > "))),
    ("term", r" [+-] " + OPERAND + r"(?=[;,)])", lambda found: ""),
    ("factor", r" \* " + OPERAND + r"(?=[;,) ])", lambda found: ""),
    ("index", r"\[[012]\]", swapped(("[0]", "[1]"), ("[1]", "[0]"), ("[2]", "[1]"))),
]
# a loop ends one earlier: one more would be undefined behavior, which is for sanitizers to see
LOOP = re.compile(r"\bfor \([^;]*;[^;]*$")
LAST = {" < ": " + 1 < ", " <= ": " < ", " > ": " - 1 > ", " >= ": " > "}
# messages, declarations of options, and sizes are not what computes
LEFT_OUT = re.compile(r'^\s*(?://|\*|/\*|#)|"|\bstatic_assert\b|\breserve\(|memory_usage|sizeof')


def without_comment(line):
    return re.sub(r"//.*", "", line)


def places(sources):
    """(file, number of the line, its text, [(name of the change, where it begins and ends, the new text)]), of all lines"""
    found = []
    for path in sorted(glob.glob(os.path.join(sources, "*", "*.cpp")) + glob.glob(os.path.join(sources, "*", "*.h"))):
        in_comment = False
        with open(path, encoding="utf-8") as file:
            for number, line in enumerate(file):
                if in_comment or line.lstrip().startswith("/*"):
                    in_comment = "*/" not in line
                    continue
                code = without_comment(line)
                if LEFT_OUT.search(code):
                    continue
                here = []
                for name, pattern, new in CHANGES:
                    for match in re.finditer(pattern, code):
                        if name == "comparison" and LOOP.search(code[:match.start()]):
                            here.append(("last", match.start(), match.end(), LAST[match.group()]))
                        elif match.group() != "0.0":
                            here.append((name, match.start(), match.end(), new(match)))
                if here:
                    found.append((os.path.relpath(path, sources), number, line, here))
    return found


# ---------------------------------------------------------------- one mistake as a choice

WORDS = re.compile(r"\s*(?:(?:return|else|do|throw)\b|(?:if|for|while|switch)\s*(?=\())")
DECLARED = re.compile(r"(?:[\w:]+|[\w:]*<[^;]*>)(?: const)? [*&]?\w")
PURE = re.compile(r"(?!.*(?:\+\+|--|[\w>]\((?<!size\()(?<!abs\()(?<!min\()(?<!max\()(?<!sqrt\()))", re.S)


def masked(text):
    """the text with blanks for comments, strings, and characters, and as long"""
    def blank(found):
        return re.sub(r"[^\n]", " ", found.group())
    return re.sub(r'//[^\n]*|/\*.*?\*/|"(?:\\.|[^"\\\n])*"|(?<!\d)\'(?:\\.|[^\'\\])\'', blank, text, flags=re.S)


def ends_expression(code, i):
    """is the character at i an operator that binds less than arithmetic and comparisons, or an end of a statement?"""
    c, before, after = code[i], code[i - 1], code[i + 1]
    if c == ":":
        return before != ":" and after != ":"
    if c == "=":
        return after != "=" and (before not in "=!<>" or code[i - 2] == before)
    return c in ";,?" or (c in "&|" and c in (before, after))


def expression(code, begin, end):
    """where the smallest whole expression around a place begins and ends"""
    depth = 0
    while True:
        c = code[begin - 1]
        if c in ")]" or (c == "}" and depth):
            depth += 1
        elif c in "([{":
            if depth == 0:
                break
            depth -= 1
        elif depth == 0 and (c == "}" or ends_expression(code, begin - 1)):
            break
        begin -= 1
    while True:    # what comes before a statement
        word = WORDS.match(code, begin)
        if not word:
            break
        begin = word.end()
        if code[begin] == "(":
            begin = closing(code, begin) + 1
    depth = 0
    while depth or not (code[end] in ")]}" or ends_expression(code, end)):
        depth += (code[end] in "([{") - (code[end] in ")]}")
        end += 1
    if code[end] == "=":    # x[0] += ...
        while code[end - 1] in "+-*/%&|^<>":
            end -= 1
    while code[begin].isspace():
        begin += 1
    return begin, end


def closing(code, at):
    depth = 0
    while True:
        depth += (code[at] in "([{") - (code[at] in ")]}")
        if depth == 0:
            return at
        at += 1


def choice(text, code, name, begin, end, new, number):
    """(begin, end, new text) of the expression around a change, that has a choice in it; None: there is none"""
    whole = text[begin:end]
    if whole in ("+=", "-="):
        last = expression(code, end, end)[1]
        return end, last, " mpm_mutant(%d) ? -(%s) : (%s)" % (number, text[end:last].strip(), text[end:last].strip())
    first, last = expression(code, begin, end)
    if not first <= begin < end <= last or "#" in code[first:last] or DECLARED.match(code, first):
        return None
    old = text[first:last].rstrip()
    changed = (text[first:begin] + new + text[end:last]).rstrip()
    if name == "comparison" and PURE.match(code[first:last]):
        return first, last, "mpm_mutant_differs(%d, %s, %s)" % (number, old, changed)
    return first, last, "(mpm_mutant(%d) ? (%s) : (%s))" % (number, changed, old)


def line_of(text, at):
    return text.count("\n", 0, at)


def what_is(name, line, begin, end, new):
    """the change and the line that it gives, without a comment"""
    return "%s: %s" % (name, without_comment(line[:begin] + new + line[end:]).strip())


def changes(sources):
    """(file, what is changed) of all mistakes that can be drawn"""
    return {(file, what_is(name, text.rstrip("\n"), begin, end, new))
            for file, _, text, here in places(sources) for name, begin, end, new in here}


class RandomMutant:
    """name, number from 1, file in src/MPM, what it is; in the whole file: the first and the last line of its expression
    (from 0), and the replacements (begin, end, text)"""

    def __init__(self, name, number, file, told):
        self.name, self.number, self.file, self.told = name, number, file, told
        self.place = file, told.partition(" ")[2]    # whatever its line is
        self.lines, self.edits = (0, 0), []


def draw(sources, seed):
    """mutants in the order of chance; those of other lines remain when one is edited. edits is empty where the place is in no
    expression"""
    order = []
    for file, line, text, here in places(sources):
        chance = random.Random("%d %s %s" % (seed, file, text))
        order.append((chance.random(), file, line, chance.choice(here)))
    for number, (_, file, line, (name, begin, end, new)) in enumerate(sorted(order), 1):
        with open(os.path.join(sources, file), encoding="utf-8") as source:
            text = source.read()
        start = sum(len(part) for part in text.splitlines(True)[:line])
        old = text[start:].partition("\n")[0]
        mutant = RandomMutant("random-%d-%d" % (seed, number), number, file, "%s:%d %s" % (
            file, line + 1, what_is(name, old, begin, end, new)))
        code = masked(text)
        edit = choice(text, code, name, start + begin, start + end, new, number)
        if edit:
            mutant.edits = [edit] + constant(text, code, edit[0])
            mutant.lines = line_of(text, min(edit[0] for edit in mutant.edits)), line_of(text, edit[1])
        yield mutant


def constant(text, code, at):
    """the replacement that makes a constant known when the program begins, if it is known to the compiler"""
    first = max(code.rfind(";", 0, at), code.rfind("}", 0, at))
    found = re.compile(r"(?<!if )\b(static )?constexpr (?=[\w:<> ]+[\[\] \w]* ?[={,])").search(code, first + 1, at)
    if not found or re.search(r"\)\s*(?:const\s*)?\{", code[found.end():at]):
        return []
    line = text[:found.start()].rpartition("\n")[2]
    return [(found.start(), found.end(), ("inline static " if found.group(1) and line else "static ") + "const ")]


HEADER = """#ifndef MPM_MUTANT_H
#define MPM_MUTANT_H
extern int mpm_mutant_active;
extern unsigned char *mpm_mutants_reached;
static inline bool mpm_mutant(int k)
{
  mpm_mutants_reached[k] = 1;
  return mpm_mutant_active == k;
}
static inline bool mpm_mutant_differs(int k, bool old, bool changed)
{
  if (old != changed) mpm_mutants_reached[k] = 1;
  return mpm_mutant_active == k ? changed : old;
}
#endif
"""

# which mutants were reached is in a file, so that all processes of a test add to it. A constant must have its value before
# the program begins
SOURCE = """#include "math/mpm_mutant.h"
#include <cstdlib>
#include <fcntl.h>
#include <sys/mman.h>
static unsigned char nowhere[%(size)d];
int mpm_mutant_active = 0;
unsigned char *mpm_mutants_reached = nowhere;
__attribute__((constructor(101))) static void mpm_mutants_begin()
{
  if (const char *number = getenv("MPM_MUTANT")) mpm_mutant_active = atoi(number);
  const char *path = getenv("MPM_REACHED");
  const int file = path ? open(path, O_RDWR) : -1;
  if (file < 0) return;
  void *shared = mmap(nullptr, %(size)d, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
  if (shared != MAP_FAILED) mpm_mutants_reached = (unsigned char *) shared;
}
"""

# for test_main.cpp and mpm_testing.py: what one case has reached, those that the program reaches before it begins among it
REPORT = [("#include <mpi.h>\n", """#include <mpi.h>
#include "math/mpm_mutant.h"
#include <algorithm>
#include <vector>
static std::vector<unsigned char> mpm_reached_before(mpm_mutants_reached, mpm_mutants_reached + %(size)d);
"""), ("{ start = std::clock(); }", """{
    if (getenv("MPM_REACHED")) {
      MPI_Barrier(MPI_COMM_WORLD);
      std::copy(mpm_reached_before.begin(), mpm_reached_before.end(), mpm_mutants_reached);
      MPI_Barrier(MPI_COMM_WORLD);
    }
    start = std::clock();
  }"""), ('::testing::Test::RecordProperty("seconds"', """if (getenv("MPM_REACHED")) {
      MPI_Barrier(MPI_COMM_WORLD);
      std::string all;
      for (int k = 0; k < %(size)d; k++)
        if (mpm_mutants_reached[k]) all += std::to_string(k) + " ";
      ::testing::Test::RecordProperty("reached", all);
    }
    ::testing::Test::RecordProperty("seconds\"""")]
REPORT_PYTHON = [("        start, used =", """        reached = os.environ.get("MPM_REACHED")
        if reached:
            with open(reached, "r+b") as bits:
                bits.write(bytes(%(size)d))
        start, used ="""), ('        case["seconds"] =', """        if reached:
            with open(reached, "rb") as bits:
                case["reached"] = " ".join(str(k) for k, bit in enumerate(bits.read()) if bit)
        case["seconds"] =""")]


def replaced(text, pairs, size):
    for old, new in pairs:
        assert text.count(old) == 1, old
        text = text.replace(old, new % {"size": size})
    return text


def with_choices(text, edits):
    """a source with these replacements, and what they need before the comment in its first line, so that numbers of lines
    remain"""
    for begin, end, new in sorted(edits, reverse=True):
        text = text[:begin] + new + text[end:]
    return '#include "math/mpm_mutant.h" ' + text


def files(root, mutants, size):
    """path -> text of the files that differ in a copy of the source tree that has these mutants; their numbers are below size"""
    def read(path):
        with open(os.path.join(root, path), encoding="utf-8") as file:
            return file.read()

    changed = {os.path.join("src", "MPM", "math", "mpm_mutant.h"): HEADER,
               os.path.join("src", "MPM", "math", "mpm_mutant.cpp"): SOURCE % {"size": size}}
    for path, pairs in (("test_main.cpp", REPORT), ("mpm_testing.py", REPORT_PYTHON)):
        path = os.path.join("unittest", path)
        changed[path] = replaced(read(path), pairs, size)
    for file in {mutant.file for mutant in mutants}:
        path = os.path.join("src", "MPM", file)
        text = read(path)
        changed[path] = with_choices(text, [edit for mutant in mutants if mutant.file == file for edit in mutant.edits])
    return changed
