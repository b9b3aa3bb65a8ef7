# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
"""Sphinx set-up of the manual:  python3 -m sphinx -W -b html doc build/doc

The pages in doc/src are written as pages of the LAMMPS manual and can be moved
there as they are.  Until then, a reference to a page that is not one of ours
becomes a link to the LAMMPS manual on the web."""

import os
import re
import shutil
import sys

from docutils import nodes
from pygments.lexer import RegexLexer
from pygments.token import Comment, Keyword, Name, Number, String, Text

project = "MPM package for LAMMPS"
SOURCES = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "src", "MPM")
with open(os.path.join(SOURCES, "base", "mpm_version.h"), encoding="utf-8") as header:
    release = version = re.search(r'MPM_VERSION "(.*)"', header.read()).group(1)
author = "the authors of the MPM package"
copyright = "distributed under the GNU General Public License, version 2"

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "tools"))
import gallery

extensions = ["sphinx.ext.mathjax"]
root_doc = "src/index"
html_static_path = ["static"]
html_css_files = ["mpm.css"]
html_show_sourcelink = False
html_copy_source = False

# the theme of the LAMMPS manual, whose navigation shows the sections of the page; without it the one of Sphinx
try:
    import sphinx_rtd_theme
    extensions.append("sphinx_rtd_theme")
    html_theme = "sphinx_rtd_theme"
    html_theme_options = {"navigation_depth": 3}
    html_js_files = ["mpm.js"]
except ImportError:
    html_theme = "alabaster"
    html_theme_options = {"fixed_sidebar": True, "page_width": "1100px", "sidebar_width": "240px"}
    html_sidebars = {"**": ["about.html", "searchbox.html", "localtoc.html", "navigation.html"]}

# formulas without a network: MathJax of the distribution is copied into the manual (Debian: libjs-mathjax).
# Without it, browsers get MathJax from the web.
MATHJAX = "/usr/share/javascript/mathjax"
MATHJAX_PARTS = ["MathJax.js", "config/TeX-AMS_CHTML.js", "extensions", "jax/element", "jax/input/TeX",
                 "jax/output/CommonHTML", "fonts/HTML-CSS/TeX/woff"]
if os.path.exists(os.path.join(MATHJAX, "config", "TeX-AMS_CHTML.js")):
    mathjax_path = "mathjax/MathJax.js?config=TeX-AMS_CHTML"
    mathjax2_config = {"showMathMenu": False, "messageStyle": "none"}

LAMMPS_MANUAL = "https://docs.lammps.org"


class LammpsLexer(RegexLexer):
    """Highlighting of LAMMPS input (in the manual of LAMMPS: its own lexer)."""

    name = "LAMMPS"
    aliases = ["LAMMPS"]
    tokens = {
        "root": [
            (r"^\s*[a-z][a-z_]*", Keyword, "line"),
            (r"#.*", Comment),
            (r"\s+", Text),
            (r".", Text),
        ],
        "line": [
            (r"&[ \t]*\n", Text),
            (r"\n", Text, "#pop"),
            (r"#.*", Comment),
            (r"\$\{[^}]*\}|\$\([^)]*\)|\$[a-z]", Name.Variable),
            (r"\"[^\"]*\"", String),
            (r"[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?(?![\w/*])", Number),
            (r"[^\s#$\"]+", Text),
            (r"\s+", Text),
            (r".", Text),
        ],
    }


def link_to_lammps_manual(app, env, node, contnode):
    """References to pages of the LAMMPS manual, such as :doc:`fix nve <fix_nve>`."""
    if node.get("refdomain") != "std" or node.get("reftype") != "doc":
        return None
    page = os.path.basename(node["reftarget"])
    if "mpm" in page.lower() or page == "create_points":
        return None    # would be ours: let Sphinx complain
    link = nodes.reference("", "", internal=False, refuri="%s/%s.html" % (LAMMPS_MANUAL, page))
    link += contnode
    return link


def add_scenes(app, page, source):
    """At the end of the page of a command or law: the scenes of the gallery that use it."""
    scenes = backlinks.get(os.path.basename(page))
    if scenes and os.path.basename(page) not in gallery.COMMON:
        links = ", ".join(":ref:`%s <scene_%s>`" % (scene["title"], scene["name"]) for scene in scenes)
        source[0] += "\n\nScenes\n\"\"\"\"\"\"\n\n%s\n" % links


backlinks = gallery.backlinks(gallery.scenes())


def add_keywords_to_index(app, page, source):
    """Entries of the index for all keywords of the tables that a page includes, which are made from the sources."""
    title = re.search(r"^([^.\s].*?)(?: command)?\n[=]+$", source[0], re.M)

    def with_index(include):
        table = open(os.path.join(app.srcdir, "src", include.group(1)), encoding="ascii").read()
        found = re.search(r"^\* keyword = (.*(?:\n  or .*)*)", table, re.M)
        words = re.findall(r"\*([^*]+)\*", found.group(1)) if found else re.findall(r"^   \* - \*([^*]+)\*", table, re.M)
        if not words or not title:
            return include.group(0)
        entries = ["   single: %s; %s" % (word.replace("\\", ""), title.group(1)) for word in sorted(set(words))]
        return "\n".join([".. index::"] + entries) + "\n\n" + include.group(0)

    source[0] = re.sub(r"^\.\. include:: ((?:options|laws)/(?!\w+_default)\S+\.inc)$", with_index, source[0], flags=re.M)


def copy_mathjax(app, exception):
    if exception is None and app.builder.format == "html" and app.config.mathjax_path.startswith("mathjax/"):
        for part in MATHJAX_PARTS:
            source, target = os.path.join(MATHJAX, part), os.path.join(app.outdir, "_static", "mathjax", part)
            os.makedirs(os.path.dirname(target), exist_ok=True)
            if os.path.isdir(source):
                shutil.copytree(source, target, dirs_exist_ok=True)
            else:
                shutil.copy(source, target)


def setup(app):
    app.add_lexer("LAMMPS", LammpsLexer)
    app.connect("source-read", add_scenes)
    app.connect("source-read", add_keywords_to_index)
    app.connect("build-finished", copy_mathjax)
    app.connect("missing-reference", link_to_lammps_manual)
