#!/usr/bin/env python3
# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
"""The gallery of the manual, doc/src/Howto_mpm_gallery.rst, from the scenes in examples.

usage: gallery.py            write the page
       gallery.py --check    exit with 1 when the page is not what the scenes give
       gallery.py --strip    draw doc/src/img/scenes.png, the pictures at the head of README.md

Title, picture, and first sentence come from the README.md of a scene, its cost from its reference log, and the
commands and laws that it uses from its input and its material files. doc/conf.py uses scenes() and
backlinks() to name on the page of each command the scenes that use it.
"""

import glob
import os
import re
import sys

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
PAGES = os.path.join(ROOT, "doc", "src")
PAGE = os.path.join(PAGES, "Howto_mpm_gallery.rst")

# in this order; a scene that is in none of them is an error
TOPICS = {
    "Impact and metals": "taylor-bar taylor-bar-axisymmetric taylor-bar-total necking spall branching double-cantilever hypervelocity "
                         "ring-on-block scratch blast-on-plate microstructure foam",
    "Elastic bodies": "rubber-band folds beam arch buckling press-fit tube plate-with-hole refined-plate airbag folded-airbag tent cook-membrane tissue two-disks ring-collision spinning-disk incline vortex hare net",
    "Heat": "cooling-plate finned-pipe quench casting friction-weld machining hot-grains",
    "Fluids and gases": "dam-break sloshing air-spring boat drop rayleigh-taylor cavity soft-disk pouring-honey coiling-honey extruder elastic-gate elastic-plate poiseuille shock-tube settling",
    "Soil and grains": "sand-column footing consolidation settlement half-space earthquake-slope levee submarine-slide landslide ball-in-sand rockfall hopper boulders-in-debris tyre-on-gravel "
                       "grains-on-block",
    "Atoms and material points": "handshake impact-on-crystal",
    "Laws and physics of your own, and Python": "point own-material own-physics python",
}
# scene -> the part of its picture: left, right, top, bottom
STRIP = {"hypervelocity": (0.0, 0.65, 0.0, 1.0), "rubber-band": (0.0, 1.0, 0.0, 1.0),
         "tyre-on-gravel": (0.0, 1.0, 0.0, 0.66), "hopper": (0.0, 1.0, 0.0, 0.6),
         "ball-in-sand": (0.35, 1.0, 0.0, 0.52), "boulders-in-debris": (0.0, 1.0, 0.0, 0.69)}

# styles: words of the input before the name -> how the page begins; PARTS: those of materials
STYLES = {"fix": (2, "fix_"), "compute": (2, "compute_"), "dump": (2, "dump_"), "region": (1, "region_"),
          "pair_style": (0, "pair_"), "atom_style": (0, "atom_style_")}
PARTS = ("eos", "strength", "damage", "viscosity", "thermal")
# the first sentence of a text: the dots of names and journals in parentheses do not end it
SENTENCE = r"(?:\((?:[^()]|\([^()]*\))*\)|[^(])*?(?:(?<=[a-z0-9)])|(?<=[A-Z]{2}))[.:](?=\s|$)"
# what every scene has
COMMON = {"atom_style_mpm", "fix_mpm", "fix_mpm_material", "create_points", "fix_mpm_dt"}


def read(path):
    with open(path, encoding="ascii") as file:
        return file.read()


def pages():
    """page -> its title"""
    return {os.path.basename(path)[:-4]: re.search(r"^([^.\n].*)\n=+$", read(path), re.M).group(1)
            for path in glob.glob(os.path.join(PAGES, "*.rst")) if path != PAGE}


def commands(path):
    """the commands of an input, as lists of words; lines that end with & go on"""
    text = re.sub(r"&[ \t]*(#.*)?\n", " ", read(path))
    for line in text.splitlines():
        words = re.sub("#.*", "", line).split()
        if words:
            yield words


def material_pages(words, known):
    """pages of the laws in the words of a material"""
    for before, word in zip([""] + words, words):
        page = ""
        if before in PARTS:
            page = "mpm_%s_%s" % (before, word)
        elif re.match(r"[-.\d$]", before):    # closed laws follow the density, other words may have the same names
            page = "mpm_law_" + word
        if page.replace("/", "_") in known:
            yield page.replace("/", "_")


def uses(folder, known):
    """pages of the commands and laws that a scene uses, in the order of the input"""
    found, variables = [], {}
    for path in sorted(glob.glob(os.path.join(folder, "in.*"))):
        for words in commands(path):
            name, after = words[0], words[1:]
            if name == "variable" and after[1:2] in (["index"], ["string"]):
                variables["${%s}" % after[0]] = [word.strip("\"'") for word in after[2:]]
            if name in STYLES and len(after) > STYLES[name][0]:
                skip, begin = STYLES[name]
                found.append(begin + after[skip].replace("/", "_"))
            found.append(name)
            if "mpm/material" in words or "material" in words:
                found += material_pages([part for word in words for part in variables.get(word, [word])], known)
            for word in words:
                file = os.path.join(ROOT, "potentials", os.path.basename(word))
                if word.endswith(".mpm") and os.path.exists(file):
                    found += material_pages(re.sub("#.*", "", read(file)).split(), known)
    return [page for k, page in enumerate(found) if page in known and page not in found[:k]]


def cost(folder, name):
    """of the reference log, as text, or nothing"""
    for path in glob.glob(os.path.join(folder, "log.*.%s.g++.1" % name)):
        runs = re.findall(r"^Loop time of (\S+) on 1 procs for (\d+) steps with (\d+) atoms", read(path), re.M)
        seconds, steps = sum(float(run[0]) for run in runs), sum(int(run[1]) for run in runs)
        if steps:
            return "%s points, %s steps, %s s on one core" % (
                runs[-1][2], steps, "%.0f" % seconds if seconds >= 10 else "%.1f" % seconds)
    return ""


def to_rst(text):
    """a sentence of Markdown"""
    text = re.sub(r"\[([^\]]*)\]\([^)]*\)", lambda m: m.group(1).split("/")[-1], text)
    return re.sub(r"`([^`]*)`", r"``\1``", text)


def scenes():
    """all scenes: dicts of name, title, alt, line, cost, uses"""
    known, all_scenes = pages(), []
    for folder in sorted(glob.glob(os.path.join(ROOT, "examples", "*", ""))):
        name = os.path.basename(os.path.dirname(folder))
        text = read(os.path.join(folder, "README.md"))
        found = re.match(r"# (.*)\n+!\[(.*)\]\(%s\.png\)\n+((?:.+\n)+)" % re.escape(name), text)
        if not found:
            sys.exit("examples/%s/README.md does not begin with a title, a picture %s.png, and a text" % (name, name))
        line = re.match(SENTENCE, found.group(3).replace("\n", " "))
        all_scenes.append({"name": name, "title": found.group(1), "alt": found.group(2),
                           "line": to_rst(re.sub(":$", ".", line.group(0) if line else found.group(3).strip())),
                           "cost": cost(folder, name), "uses": uses(folder, known)})
    return all_scenes


def backlinks(all_scenes):
    """page -> scenes that use it"""
    links = {}
    for scene in all_scenes:
        for page in scene["uses"]:
            links.setdefault(page, []).append(scene)
    return links


def page():
    known, by_name = pages(), {scene["name"]: scene for scene in scenes()}
    wrong = set(by_name) ^ {name for names in TOPICS.values() for name in names.split()}
    if wrong:
        sys.exit("these are scenes or in TOPICS of tools/gallery.py, but not both: " + ", ".join(sorted(wrong)))
    out = [".. This page is made by tools/gallery.py.", "", "Gallery of scenes", "=================", "",
           "All scenes are in the folder *examples*, each with an input, a README that says what to look at, and the",
           "log of a run. Times are those of the logs. Each scene also uses the commands that all of them need:",
           ", ".join(":doc:`%s <%s>`" % (known[p].replace(" command", ""), p) for p in sorted(COMMON)) + ".", ""]
    for topic, names in TOPICS.items():
        out += [topic, '"' * len(topic), "", ".. list-table::", "   :widths: 38 62", ""]
        for name in names.split():
            scene = by_name[name]
            links = ", ".join(":doc:`%s <%s>`" % (known[p].replace(" command", ""), p)
                              for p in scene["uses"] if p not in COMMON)
            out += ["   * - .. image:: ../../examples/%s/%s.png" % (name, name),
                    "          :width: 280px", "          :alt: " + scene["alt"], "",
                    "     - .. _scene_%s:" % name, "", "       **%s** (*examples/%s*)" % (scene["title"], name), "",
                    "       " + scene["line"], ""]
            if scene["cost"]:
                out += ["       " + scene["cost"] + ".", ""]
            if links:
                out += ["       Uses " + links + ".", ""]
    return "\n".join(out).rstrip() + "\n"


def strip():
    """six pictures at one size"""
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    known = {scene["name"]: scene for scene in scenes()}
    figure, axes = plt.subplots(2, 3, figsize=(10.8, 5.4), dpi=100)
    figure.subplots_adjust(0.01, 0.01, 0.99, 0.99, 0.03, 0.06)
    for axis, (name, (left, right, top, bottom)) in zip(axes.flat, STRIP.items()):
        picture = plt.imread(os.path.join(ROOT, "examples", name, name + ".png"))
        rows, columns = picture.shape[:2]
        axis.imshow(picture[int(top * rows):int(bottom * rows), int(left * columns):int(right * columns)],
                    interpolation="antialiased")
        axis.axis("off")
        place = axis.get_subplotspec().get_position(figure)
        axis.set_position([place.x0, place.y0, place.width, place.height * 0.9])
        axis.set_anchor("C")
        figure.text(place.x0 + place.width / 2, place.y1, known[name]["title"], ha="center", va="top", fontsize=11)
    figure.savefig(os.path.join(PAGES, "img", "scenes.png"))


def main():
    if "--strip" in sys.argv:
        strip()
        return
    text = page()
    old = read(PAGE) if os.path.exists(PAGE) else ""
    if "--check" in sys.argv:
        if text != old:
            sys.exit("doc/src/Howto_mpm_gallery.rst is not what the scenes give: run tools/gallery.py")
    elif text != old:
        with open(PAGE, "w", encoding="ascii") as file:
            file.write(text)
        print("wrote doc/src/Howto_mpm_gallery.rst")


if __name__ == "__main__":
    main()
