# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
#
# labels: docs
# sanitize: no
# timeout: 300
"""The manual builds without warnings, is complete, and its links lead somewhere. (That its examples
run is tested in test_docs_examples.py.)"""

import glob
import os
import re
import subprocess
import sys
import tempfile

import mpm_testing as mt

read = mt.read

ROOT = mt.ROOT
PAGES = os.path.join(ROOT, "doc", "src")
SOURCES = os.path.join(ROOT, "src", "MPM")

# macro in a header -> how its page begins and what its title says
KINDS = {
    "AtomStyle": ("atom_style_", "atom_style"),
    "CommandStyle": ("", ""),
    "ComputeStyle": ("compute_", "compute"),
    "DumpStyle": ("dump_", "dump"),
    "FixStyle": ("fix_", "fix"),
    "PairStyle": ("pair_", "pair_style"),
    "RegionStyle": ("region_", "region"),
}
SECTIONS = ["Syntax", "Examples", "Description", "Restrictions", "Related commands", "Default"]


def relative(path):
    return os.path.relpath(path, ROOT)


def styles():
    """page name without .rst -> title of the page"""
    found = {}
    for header in glob.glob(os.path.join(SOURCES, "*", "*.h")):
        for macro, name in re.findall(r"^(\w+Style)\((\S+?),\s*\w+\)", read(header), re.M):
            page, title = KINDS[macro]
            found[page + name.replace("/", "_")] = (title + " " + name).strip()
    return found


def law_tables():
    """page name without .rst -> PART_NAME of the table that it includes; a page mpm_law_NAME is
    that of a closed law. test_law_tables keeps the tables in step with the laws."""
    tables = [os.path.basename(path)[:-4] for path in glob.glob(os.path.join(PAGES, "laws", "*"))]
    return {"mpm_" + re.sub("^closed_", "law_", table): table for table in tables}


def pages():
    return sorted(glob.glob(os.path.join(PAGES, "*.rst")))


def readmes():
    """also notes beside them, such as src/MPM/*/DECISIONS.md"""
    return [os.path.join(ROOT, "README.md")] + sorted(
        glob.glob(os.path.join(ROOT, "*", "README.md")) +
        glob.glob(os.path.join(ROOT, "examples", "*", "README.md")) +
        glob.glob(os.path.join(SOURCES, "README.md")) +
        glob.glob(os.path.join(SOURCES, "*", "*.md")))


def find_python():
    """a Python that has Sphinx, or None"""
    for python in (sys.executable, "python3", "/usr/bin/python3"):
        try:
            if subprocess.run([python, "-c", "import sphinx"], capture_output=True).returncode == 0:
                return python
        except OSError:
            pass
    return None


def check(wrong):
    assert not wrong, "\n" + "\n".join(wrong)


def test_builds_without_warnings():
    python = find_python()
    if not python:
        raise mt.Skip("Sphinx is not installed")
    with tempfile.TemporaryDirectory() as folder:
        result = mt.run([python, "-m", "sphinx", "-q", "-W", "--keep-going", "-b", "html",
                         os.path.join(ROOT, "doc"), folder])
        assert result.code == 0, "\n" + result.output
        check(missing_in_index(folder) + scripts_from_the_web(folder))


def missing_in_index(folder):
    """keywords of the tables of options that are not in the index of the built manual"""
    index = re.sub(r"<[^>]*>", "\n", read(os.path.join(folder, "genindex.html")))
    entries = {line.strip() for line in index.splitlines()}
    tables = [path for path in glob.glob(os.path.join(PAGES, "options", "*.inc")) if "_default" not in path]
    assert len(tables) > 10
    wrong = []
    for path in tables:
        words = re.search(r"^\* keyword = (.*(?:\n  or .*)*)", read(path), re.M)
        for word in re.findall(r"\*([^*]+)\*", words.group(1)) if words else []:
            if word not in entries:
                wrong.append("%s: %s is not in the index" % (relative(path), word))
    return wrong


def scripts_from_the_web(folder):
    """of pages that shall show formulas without a network"""
    if not os.path.exists("/usr/share/javascript/mathjax/MathJax.js"):
        return []
    wrong = ["%s loads %s" % (os.path.basename(path), script) for path in glob.glob(os.path.join(folder, "src", "*.html"))
             for script in re.findall(r'<script[^>]*src="(\w+:[^"]*)"', read(path))]
    used = re.search(r'src="\.\./(_static/mathjax/[^"?]*)\?config=(\w+-\w+)"', read(os.path.join(folder, "src", "fix_mpm.html")))
    if not used:
        return wrong + ["fix_mpm.html does not load MathJax"]
    top = os.path.dirname(used.group(1))
    for name in (used.group(1), top + "/config/%s.js" % used.group(2), top + "/jax/output/CommonHTML/fonts/TeX/fontdata.js",
                 top + "/fonts/HTML-CSS/TeX/woff/MathJax_Main-Regular.woff"):
        if not os.path.exists(os.path.join(folder, name)):
            wrong.append(name + " is not in the built manual")
    return wrong


def test_numbers_of_the_ledger_agree():
    """the table of the page with the source, and what other pages say of single entries with the table"""
    page = read(os.path.join(PAGES, "compute_mpm_energy.rst"))
    table = dict(re.findall(r"^   \* - (\d+)\n     - (\w+)$", page, re.M))
    source = read(os.path.join(SOURCES, "output", "compute_mpm_energy.h"))
    entries = re.findall(r"^ +([A-Z]+)[,\s]", source[source.index("enum Entry"):source.index("};", source.index("enum Entry"))], re.M)
    assert [name.upper() for name in table.values()] + ["NENTRY"] == entries, "%s\n%s" % (table, entries)
    assert list(table) == [str(k + 1) for k in range(len(table))], table
    wrong = []
    for path in pages() + readmes():
        for number, name in re.findall(r"\b[Ee]ntry (\d+), \*(\w+)\*", read(path)):
            if table.get(number) != name:
                wrong.append("%s: entry %s is not %s" % (relative(path), number, name))
    check(wrong)


def test_text_is_ascii():
    wrong = []
    for path in pages() + readmes() + [os.path.join(ROOT, "doc", "conf.py")]:
        if not os.path.exists(path):
            wrong.append(relative(path) + " is missing")
            continue
        for number, line in enumerate(read(path).splitlines(), 1):
            if not line.isascii():
                wrong.append("%s:%d: not 7-bit ASCII: %s" % (relative(path), number, ascii(line)))
    check(wrong)


def test_every_style_has_a_page_and_every_page_a_style():
    known, laws = styles(), law_tables()
    have = {os.path.basename(path)[:-4] for path in pages()}
    wrong = ["%s has no page doc/src/%s.rst" % (known[page], page)
             for page in sorted(set(known) - have)]
    for page in sorted(have - set(known)):
        if page != "index" and page not in laws and not page.startswith(("Howto_", "Developer_")):
            wrong.append("doc/src/%s.rst is the page of no style and of no law" % page)
    check(wrong)


def test_the_guide_links_every_style_and_every_other_guide():
    text = read(os.path.join(PAGES, "Howto_mpm.rst"))
    guides = [os.path.basename(path)[:-4] for path in pages() if "Howto_" in os.path.basename(path)]
    check(["doc/src/Howto_mpm.rst has no link to %s" % page
           for page in sorted(set(styles()) | set(guides) - {"Howto_mpm"})
           if not re.search(r":doc:`[^`]*<%s>`" % page, text)])


def test_the_readme_counts_the_styles():
    names = ("no one two three four five six seven eight nine ten eleven twelve thirteen fourteen fifteen sixteen "
             "seventeen eighteen nineteen twenty twenty-one twenty-two twenty-three twenty-four twenty-five twenty-six "
             "twenty-seven twenty-eight twenty-nine thirty thirty-one thirty-two").split()
    text = " ".join(read(os.path.join(ROOT, "README.md")).split())
    have, wrong = list(styles()), []
    for begin, what in (("atom_style_", "atom style"), ("pair_", "pair style"), ("region_", "region"),
                        ("fix_", "fix"), ("compute_", "compute"), ("dump_", "dump"), ("", "command")):
        mine = [page for page in have if page.startswith(begin)]
        have = [page for page in have if page not in mine]
        said = "%s %s" % (names[len(mine)], what + ("es" if what == "fix" else "s")[:2 * (len(mine) > 1)])
        if not re.search(r"\b%s\b" % said, text):
            wrong.append("README.md does not say '%s'" % said)
    check(wrong)


def test_every_law_and_every_material_file_is_in_the_page_of_the_fix():
    text = read(os.path.join(PAGES, "fix_mpm_material.rst"))
    syntax = text[:text.index("\nExamples\n")]
    check(["doc/src/fix_mpm_material.rst: no law %s in the syntax" % page
           for page in sorted(law_tables()) if "<%s>`" % page not in syntax] +
          ["doc/src/fix_mpm_material.rst: no file %s in the table" % os.path.basename(path)
           for path in sorted(glob.glob(os.path.join(ROOT, "potentials", "*.mpm")))
           if not re.search(r"\b%s\b" % re.escape(os.path.basename(path)), text)])


def test_every_law_has_a_page_that_includes_its_table():
    laws = law_tables()
    assert laws, "no tables in doc/src/laws: run tools/tables.sh"
    wrong = []
    for page, table in sorted(laws.items()):
        path = os.path.join(PAGES, page + ".rst")
        if not os.path.exists(path):
            wrong.append("law %s has no page doc/src/%s.rst" % (table, page))
        elif ".. include:: laws/%s.inc\n" % table not in read(path):
            wrong.append("doc/src/%s.rst: no line '.. include:: laws/%s.inc'" % (page, table))
    check(wrong)


def test_every_law_page_tells_cost_use_and_references():
    """each section with a text; a measured cost; where the law comes from"""
    sections = ["Syntax", "Examples", "Description", "Parameters", "Cost", "When to use it",
                "Related commands"]
    wrong = []
    for page in sorted(law_tables()):
        path = os.path.join(PAGES, page + ".rst")
        if not os.path.exists(path):
            continue
        parts = re.split(r"^([A-Z].*)\n\"+\n", read(path), flags=re.M)
        text = dict(zip(parts[1::2], parts[2::2]))
        order = [name for name in parts[1::2] if name in sections]
        for section in sections:
            if not text.get(section, "").strip():
                wrong.append("%s: section '%s' is missing" % (relative(path), section))
        if order != [name for name in sections if name in order]:
            wrong.append("%s: sections are out of order" % relative(path))
        if len(text.get("When to use it", "").split()) < 15:
            wrong.append("%s: 'When to use it' says too little" % relative(path))
        if not re.search(r"\d ns\b|^None\b", text.get("Cost", "").strip()):
            wrong.append("%s: no nanoseconds in 'Cost'" % relative(path))
        if not re.search(r"^\.\. _[\w-]+:\n\n\*\*\(.+\)\*\* .*\n?.*\(\d{4}\)",
                         read(path), re.M):
            wrong.append("%s: no reference" % relative(path))
    check(wrong)


def test_pages_have_the_order_of_the_lammps_manual():
    wrong = []
    for page, style in sorted(styles().items()):
        path = os.path.join(PAGES, page + ".rst")
        if not os.path.exists(path):
            continue
        text = read(path)
        if ".. index:: %s\n" % style not in text.split("=====")[0]:
            wrong.append("%s: does not begin with .. index:: %s" % (relative(path), style))
        if not re.search(r"^%s command\n=+\n" % re.escape(style), text, re.M):
            wrong.append("%s: title is not '%s command'" % (relative(path), style))
        place = 0
        for section in SECTIONS:
            found = re.search(r"^%s\n\"{%d}\n" % (section, len(section)), text, re.M)
            if not found:
                wrong.append("%s: section '%s' is missing" % (relative(path), section))
            elif found.start() < place:
                wrong.append("%s: section '%s' is out of order" % (relative(path), section))
            else:
                place = found.start()
        if ".. versionadded::" not in text:
            wrong.append("%s: no versionadded" % relative(path))
        if "part of the MPM package" not in text:
            wrong.append("%s: Restrictions do not name the package" % relative(path))
    check(wrong)


def test_every_keyword_of_fix_mpm_is_described():
    """all on its own page, those that have a page of details also there"""
    table = read(os.path.join(PAGES, "options", "fix_mpm.inc"))
    words = re.findall(r"\*([^*]+)\*", re.search(r"^\* keyword = (.*(?:\n  or .*)*)", table, re.M).group(1))
    said = read(os.path.join(PAGES, "fix_mpm.rst")).split("\nDescription\n")[1].split("\nRestart, fix_modify")[0].lower()
    wrong = ["doc/src/fix_mpm.rst: nothing about " + word for word in words if not re.search(r"\*%s\b" % word, said)]
    for name in ("shapes", "transfers", "schemes", "frames", "locking"):
        text = read(os.path.join(PAGES, "Howto_mpm_%s.rst" % name))
        for word in re.findall(r"^   single: (\w+); fix mpm$", text, re.M):
            if word not in words or not re.search(r"\*%s\b" % word, text.split("\n====")[1], re.I):
                wrong.append("doc/src/Howto_mpm_%s.rst: nothing about %s" % (name, word))
    check(wrong)


def test_links_lead_somewhere():
    """to pages of the LAMMPS manual (where its sources are there), and to files in README.md"""
    wrong = []
    for path in readmes():
        if not os.path.exists(path):
            continue
        for target in re.findall(r"\]\(([^)#\s]+)\)", read(path)):
            file = os.path.join(os.path.dirname(path), target)
            if not re.match(r"\w+:", target) and not os.path.exists(file):
                wrong.append("%s: no %s" % (relative(path), target))

    manuals = [os.path.join(tree, "doc", "src") for tree in mt.lammps_sources()]
    manuals = [folder for folder in manuals if os.path.isdir(folder)]
    if manuals:
        for path in pages():
            for target in re.findall(r":doc:`[^`<]*<([^>`]*)>`", read(path)):
                if not any(os.path.exists(os.path.join(folder, target + ".rst"))
                           for folder in (PAGES, manuals[-1])):
                    wrong.append("%s: no page %s in the LAMMPS manual" % (relative(path), target))
    check(wrong)


def test_every_scene_says_what_to_look_at():
    wrong = []
    for folder in sorted(glob.glob(os.path.join(ROOT, "examples", "*", ""))):
        name = os.path.basename(os.path.dirname(folder))
        text = read(os.path.join(folder, "README.md"))
        if not re.search(r"plot\.py|python\.py|plot_point\.py|picture\.py", text):
            wrong.append("examples/%s/README.md: does not say what draws its picture" % name)
        for part in ("(%s.png)" % name, "in.%s" % name, "\n## What to look at\n"):
            if part not in text:
                wrong.append("examples/%s/README.md: no %s" % (name, part.strip()))
    check(wrong)


def test_gallery_is_that_of_the_scenes():
    result = mt.run([sys.executable, os.path.join(ROOT, "tools", "gallery.py"), "--check"])
    assert result.code == 0, result.output


def test_page_of_the_atlas_is_what_its_tables_give():
    for name in ("atlas_page.py", "physics.py"):
        result = mt.run([sys.executable, os.path.join(ROOT, "bench", "atlas", name), "--check"])
        assert result.code == 0, result.output


def test_first_input_of_the_readme_runs_as_it_is():
    """Experiment (examples/taylor-bar/README.md): 16.2 mm are left of the bar; 5 % at this spacing. A point stands
    for half a millimeter."""
    text = read(os.path.join(ROOT, "README.md"))
    section = text[text.index("## A first input"):]
    lines = re.search(r"^```\n(.*?)^```", section, re.M | re.S).group(1)
    with tempfile.TemporaryDirectory() as folder:
        result = mt.ok(mt.lammps(folder, lines))
        assert "WARNING" not in result.output, result.output
        for name in ("bar.700.png", "bar.pvd"):
            assert os.path.exists(os.path.join(folder, name)), name + " is missing"
    last = re.findall(r"^ +\d+ +([-.\de]+) +([-.\de]+) +[-.\de]+ *$", result.output, re.M)[-1]
    assert float(last[0]) == 8.0e-5, last
    length = float(last[1]) + 0.25e-3
    assert abs(length - 16.2e-3) < 0.05 * 16.2e-3, length


mt.main(globals())
