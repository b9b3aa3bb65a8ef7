# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
#
# labels: docs
# sanitize: no
"""Checks that can fire. Patterns of styles have only what LAMMPS's matcher knows; with anything else a check matches
nothing, and nobody sees it. And what a page says is refused has a test: each keyword and style that such a sentence
names occurs in a test of errors together with the style of the page."""

import glob
import os
import re

import mpm_testing as mt

PAGES = ("fix_mpm*", "pair_mpm*", "region_mpm*", "compute_mpm*", "dump_mpm*", "create_points", "mpm_geostatic")
PROMISE = re.compile(r"\brefused\b|\brefuses\b|cannot be (used|combined|in the group)|\bis an error\b|"
                     r"\bstops with an error\b|[Tt]here can be only one")
# words of an expected error, in C++ and Python
EXPECTS = re.compile(r"expect_\w*(error|refused|explained)|\brefused\(|\.error\(|error_of|\bMistake\b|\bChange\b|"
                     r"failure\(|\bRefusal\b|\banswer\(|ERROR|mistakes_in")
# calls whose first string is a pattern of LAMMPS
MATCHERS = re.compile(r"(?:get_(?:fix|compute|dump)_by_style|strmatch|strfind|pair_match|only)\s*\(")

# Sentences that name something which needs no test of this kind: a part of the page's text, and the reason
EXCEPTIONS = {
    # these two are refused by LAMMPS itself, for any pair style without single()
    ("pair_mpm_sheet", "Compute group/group"): "LAMMPS",
    ("dump_mpm_vtk", "LAMMPS refuses *sort*"): "LAMMPS",
    ("dump_mpm_vtk", "Keywords that concern text"): "most have no effect, which is no refusal",
    ("fix_mpm_elements", "If an element is stretched beyond this cutoff"): "the keyword is the remedy",
    # tested under another name
    ("fix_mpm_immersed", "grains that *fix rigid* moves"): "test_immersed.cpp: rigid/nve",
    ("fix_mpm_deform", "*Stop yes* of"): "test_deform.cpp: use stop no; yes is the default",
    ("fix_mpm_handshake", "*axisymmetric*, *every*"): "one condition with frame total, which is tested",
    ("fix_mpm", "command with *pre no*"): "test_remedies.cpp: AnewField and others",
    ("fix_mpm_pore", "*K0* beyond yield"): "test_pore.cpp: within its yield surface",
    ("mpm_geostatic", "*K0* beyond yield"): "test_geostatic.cpp: within its yield surface",
}


def sources(*endings):
    return sorted(path for ending in endings
                  for path in glob.glob(os.path.join(mt.ROOT, "src", "**", "*" + ending), recursive=True))


def patterns(text):
    """strings of the source that are patterns: they start with ^, or end with $"""
    return [found for found in re.findall(r'"((?:[^"\\\n]|\\.)*)"', text)
            if re.match(r"\^[\w\[]", found) or re.search(r"\w\$$", found)]


def unknown_syntax(pattern):
    """what LAMMPS's matcher does not know in a pattern: alternatives, groups, counts, lazy repetition"""
    plain = re.sub(r"\\.|\[[^\]]*\]", "", pattern)
    return re.findall(r"[|(){}]|[*+?][*+?]|\$.|.\^", plain)


def test_unknown_syntax_is_seen():
    for bad in (r"^mpm/(elements|mixture)$", r"^mpm/dt$|^dt/reset", r"^a{2}$", r"^a.*?b"):
        assert unknown_syntax(bad), bad
    for good in (r"^mpm$", r"^[cfvid]2?_", r"^gran", r"/omp$", r"^[A-Z]"):
        assert not unknown_syntax(good), good


def test_patterns_of_styles():
    bad, n = [], 0
    for path in sources(".cpp", ".h"):
        text = re.sub(r"/\*.*?\*/|//[^\n]*", "", mt.read(path), flags=re.S)
        found = patterns(text)
        n += len(found)
        bad += [f"{os.path.relpath(path, mt.ROOT)}: {pattern}" for pattern in found if unknown_syntax(pattern)]
    assert n > 50, f"only {n} patterns found"
    assert not bad, "patterns that LAMMPS cannot match: " + "; ".join(bad)


def sentences(path):
    """sentences of a page, without code, tables, and notes of LAMMPS"""
    paragraphs = re.split(r"\n\s*\n", mt.read(path))
    for paragraph in paragraphs:
        if paragraph.startswith((".. ", "   ", "+-", "|")):
            continue
        text = " ".join(paragraph.split())
        for sentence in re.split(r"(?<=[.:]) +(?=[A-Z*:])", text):
            yield sentence


def things(sentence, style):
    """keywords and styles that a sentence names, except those of the page"""
    found = re.findall(r"(?<![*\w])\*([\w/ -]+)\*(?![*\w])", sentence)
    found += re.findall(r":doc:`([^<`]+)", sentence)
    found = [thing.strip()[:1].lower() + thing.strip()[1:] for thing in found]
    found = [re.sub(r"^(fix|pair_style|pair|compute) ", "", thing) for thing in found]
    found = [re.sub(r" (\d+|[A-Z])$", "", thing) for thing in found]
    return [thing for thing in found if thing not in (style, style.replace("mpm/", ""), "mpm", "fix", "")]


def promises():
    """(page, sentence, things) of each sentence that promises a refusal"""
    for pattern in PAGES:
        for path in sorted(glob.glob(os.path.join(mt.ROOT, "doc", "src", pattern + ".rst"))):
            page = os.path.basename(path)[:-4]
            kind, _, rest = page.partition("_")
            style = rest.replace("_", "/") if kind in ("fix", "pair", "region", "compute", "dump") else page
            for sentence in sentences(path):
                if PROMISE.search(sentence):
                    yield page, style, sentence, things(sentence, style)


def blocks():
    """blocks of tests that expect errors, each with the file that it is in"""
    for path in sorted(glob.glob(os.path.join(mt.ROOT, "unittest", "**", "test_*"), recursive=True)):
        if not path.endswith((".cpp", ".py")) or os.path.basename(path) == os.path.basename(__file__):
            continue
        text = mt.read(path).replace("\\n", " ")    # ends of lines in scenes
        for block in re.split(r"\n(?=\S)(?<=\n\n)", text):
            if EXPECTS.search(block):
                yield text, block


def has_words(text, name):
    return all(re.search(r"(?<![\w/])" + re.escape(word) + r"(?![\w/])", text) for word in name.split())


def missing():
    all_blocks = list(blocks())
    for page, style, sentence, names in promises():
        if any(page == where and part in sentence for where, part in EXCEPTIONS):
            continue
        for name in names:
            if not any(has_words(block, name) and (style in text) for text, block in all_blocks):
                yield page, name, sentence


def test_promised_refusals_are_tested():
    found = list(promises())
    assert len(found) > 100, f"only {len(found)} promises found"
    lacks = [f"{page}: {name}: {sentence}" for page, name, sentence in missing()]
    assert not lacks, f"{len(lacks)} refusals of pages have no test:\n" + "\n".join(lacks)


def test_exceptions_are_needed():
    for page, part in EXCEPTIONS:
        assert any(page == where and part in sentence for where, _, sentence, _ in promises()), (page, part)


mt.main(globals())
