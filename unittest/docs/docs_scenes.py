# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
"""Scenes around the examples of the manual: what each line needs and does not show is added."""

import glob
import os
import re
import sys

ROOT = os.environ.get("MPM_ROOT", os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__)))))
PAGES = os.path.join(ROOT, "doc", "src")

HEAD = """
units           si
boundary        f f f
atom_style      {style}
neighbor        0.001 bin
region          box block 0 {x:g} 0 {x:g} 0 {z:g}
create_box      3 box
comm_modify     vel yes
"""
GRID = "fix grid all mpm 0.01\n"
POINTS = """
region          base block $(0.2*lx) $(0.5*lx) $(0.2*lx) $(0.5*lx) $(0.2*lx) $(0.5*lx)
create_points   1 region base spacing $(0.05*lx)
"""
FLUID = "fix default all mpm/material density 1000 eos linear 1.0e6\n"
MATERIAL = "fix default all mpm/material density 1000 eos linear 1.0e6 strength j2 1.0e6 1.0e9\n"

# names that examples use without showing where they come from
GROUPS = ["bar", "rod", "solid", "solids"]
REGIONS = {"bar": "block 0.01 0.04 0.01 0.04 0.01 0.04", "ball": "sphere 0.06 0.06 0.06 0.02",
           "plate": "block 0.01 0.09 0.01 0.09 0.01 0.02", "soil": "block -0.02 0.12 0 0.1 0 0.03",
           "forest": "block 0.06 INF INF INF INF INF", "ice": "block INF 0.02 INF INF INF INF",
           "shell": "cylinder z 0.05 0.05 0.045 INF INF side out", "lid": "plane 0 0.05 0 0 -1 0",
           "inlet": "block 0.07 0.09 0.07 0.09 0.07 0.09", "drain": "block INF 0.025 INF INF INF INF"}
CORNERS = [(0, 0, 0), (9, 0, 0), (0, 9, 0), (0, 0, 9)]
FACES = [(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)]


def solid(faces):
    """An STL file."""
    return "solid tool\n%sendsolid\n" % "".join(
        "facet\nouter loop\n%sendloop\nendfacet\n" % "".join("vertex %d %d %d\n" % CORNERS[k] for k in face)
        for face in faces)


TOOL, SCAN, TERRAIN = solid(FACES), solid(FACES[:3]), solid(FACES[3:])    # a tetrahedron, one with a hole, one face
VARIABLES = {"down": "equal 1.0e-3", "T": "equal 300+step", "laser": "atom 1.0e6*x", "depth": "equal -0.1*step*dt",
             "p": "equal 1.0e3*step", "damage": "atom id", "speed": "equal 0.1",
             "px": "internal 0", "py": "internal 0", "pz": "internal 0", "n": "equal 1+(v_pz>0.02)"}
COMPUTES = {"mine": "all property/atom vx vy"}
FIXES = {"fine": "all mpm 0.01"}
# a tetrahedron, for lines that read a mesh
MESH_FILE = """$MeshFormat
2.2 0 8
$EndMeshFormat
$Nodes
4
1 0 0 0
2 %g 0 0
3 0 %g 0
4 0 0 %g
$EndNodes
$Elements
1
1 4 2 1 1 1 2 3 4
$EndElements
"""
# pictures, values without a header, and tables, for lines that read them
PICTURE = "P2\n4 3\n255\n0 90 200 255\n0 60 120 180\n255 0 0 0\n"
DUMP = """<VTKFile type="PolyData" byte_order="%s">
<Piece NumberOfPoints="1">
<PointData><DataArray type="Float64" Name="volume0" format="ascii">1e-6</DataArray></PointData>
<Points><DataArray type="Float64" NumberOfComponents="3" format="ascii">0.05 0.05 0.05</DataArray></Points>
</Piece>
</VTKFile>
""" % (sys.byteorder.capitalize() + "Endian")
IMAGES = {"grains.csv": b"x,y,z,mass,rho\n50,50,50,1e-3,2.7\n", "bar.5000.vtp": DUMP.encode(), "grains.pgm": PICTURE.encode(), "map.ppm": b"P3\n2 1\n255\n255 0 0  0 0 255\n",
          "scan.raw": bytes(range(0, 240, 10)), **{"scan_%04d.pgm" % k: PICTURE.encode() for k in range(3)}}
# pages whose inputs test_docs_tasks.py runs and checks
TASKS = ["Howto_mpm_" + name for name in
         "tutorial tensile two_bodies grains points restart loads loop until pictures scaling".split()]
BODIES = ["left", "right", "plane", "disk", "block", "pad", "disc", "floor"]    # each with a fix mpm, or on one mesh


def blocks(path):
    """(section, lines) of the LAMMPS code blocks of a page; continued lines are joined."""
    section, found, lines, indent = "", [], None, 0
    text = open(path, encoding="ascii").read()
    rows = text.splitlines()
    for k, row in enumerate(rows):
        if k + 1 < len(rows) and re.match(r'^([="\'^~-])\1{3,}$', rows[k + 1]):
            section = row.strip()
        if row.strip() == ".. code-block:: LAMMPS":
            lines = []
            indent = len(row) - len(row.lstrip())
            found.append((section, lines))
        elif lines is not None:
            if row.strip() and len(row) - len(row.lstrip()) <= indent:
                lines = None
            elif row.strip():
                lines.append(row.strip())
    joined = []
    for section, lines in found:
        text = re.sub(r"&\s*\n", " ", "\n".join(lines))
        joined.append((section, text.splitlines()))
    return joined


def pages():
    return sorted(glob.glob(os.path.join(PAGES, "*.rst")))


def examples(path):
    return [line for section, lines in blocks(path) if section == "Examples" for line in lines]


def mentions(line, kind, name):
    """Does a command use this ID?"""
    pattern = {"compute": r"\bc_%s\b", "fix": r"\bf_%s\b|\bfix %s\b", "variable": r"\bv_%s\b",
               "region": r"\b(?:region|patch|mpm/rigid|implicit yes stick) %s\b"}.get(kind, r"(?<!_)\b%s\b")
    pattern = pattern.replace("%s", re.escape(name))
    words = line.split()
    own = words[0] == kind and words[1] == name
    return not own and re.search(pattern, line) is not None


def prerequisites(line, before):
    """Earlier lines of the same block that define what this line uses."""
    needed = []
    for earlier in reversed(before):
        words = earlier.split()
        if len(words) < 2 or words[0] not in ("compute", "fix", "region", "variable", "dump"):
            continue
        uses = any(mentions(later, words[0], words[1]) for later in [line] + needed)
        if words[0] == "fix":
            uses = uses or any(re.search(r"(?<!_)\b%s\b" % re.escape(words[1]),
                                         " ".join(later.split()[2:])) for later in [line] + needed)
        if line.startswith("dump_modify"):
            uses = uses or (words[0] == "dump" and line.split()[1] == words[1])
        if uses and not any(later.split()[:2] == words[:2] for later in [line] + needed):
            needed.insert(0, earlier)
    styles = [earlier for earlier in before if earlier.startswith("pair_style")]
    return (styles[-1:] if line.startswith("pair_coeff") else []) + needed


GRAINS = """comm_modify vel yes
create_atoms 3 single 0.05 0.05 0.09
group grains type 3
set type 3 diameter 0.004 density 1000
pair_style gran/hooke 1.0e4 NULL 50.0 NULL 0.5 0
pair_coeff * *
neigh_modify exclude type 1 1
"""


def scene_for(lines):
    """A scene around lines of an example, which has what they need and does not show."""
    if "mpm/handshake" in lines[-1]:
        return crystal_for(lines)
    text, before = "\n".join(lines), ""
    with_grains = re.search(r"mpm/dt .*\bgrains\b", text)
    style = "hybrid sphere mpm" if with_grains or re.search("diameter|mpm/surface|mpm/immersed", text) else "mpm"
    grid = re.search(r"^fix grid all mpm (\S+)", text, re.M)
    h = float(grid.group(1)) if grid else 0.0
    head = HEAD.format(style=style, x=32 * h or 0.1, z=60 * h or 0.1)
    for names, command in ((REGIONS, "region"), (VARIABLES, "variable"), (COMPUTES, "compute")):
        for name, rest in names.items():
            if any(mentions(line, command, name) for line in lines):
                before += "%s %s %s\n" % (command, name, rest)

    # a line may take the place of a part of the scene
    own_field = re.search(r"^fix\s+(\S+)\s+(\S+)\s+mpm\s", text, re.M)
    grid = "" if own_field and own_field.group(1) != "grid" else GRID
    makes_points = "create_points" in text
    if makes_points:
        for name, rest in FIXES.items():
            if re.search(r"\bfix %s\b" % name, text):
                grid = "fix %s %s\n" % (name, rest)
    of_pairs = "mpm/heat penalty" in text
    pairs = "pair_style mpm/penalty" in text or of_pairs
    if of_pairs:
        before += "pair_style mpm/penalty\npair_coeff * * 1.0e7 friction 0.3 0.01\n"
    heat_contact = re.search(r"mpm/heat .*\bcontact ", text)
    if "mpm/contact" in text or pairs or heat_contact:
        named = BODIES[:2] if pairs else [word for word in text.split() if word in BODIES]
        grid = "".join("group %s type %d\nfix %s %s mpm 0.01\n" % (name, k + 1, name, name)
                       for k, name in enumerate(named))
        low, high, step = (0.05, 0.09, 0.02) if "law cohesive" in text else (0.06, 0.08, 0.03)    # side by side, to be bonded
        for k in range(len(named)):
            before += ("region body%d block %g %g %g %g %g %g\n"
                       "create_points %d region body%d ppc 2\ngroup %s type %d\n" %
                       (k, low, high, step * k + 0.01, step * k + 0.03, low, high, k + 1, k, named[k], k + 1))
    if "damage phasefield" in text and "mpm/phasefield" not in text:
        before += "fix cracks all mpm/phasefield\n"
    on_one_mesh = "mpm/mesh/contact" in text
    if on_one_mesh:
        grid = "fix grid all mpm/mesh wide.msh\n"
        for k, name in enumerate(word for word in text.split() if word in BODIES):
            before += ("region body%d block 0.06 0.08 %g %g 0.06 0.08\n"
                       "create_points %d region body%d spacing 0.005\ngroup %s type %d\n" %
                       (k, 0.03 * k + 0.01, 0.03 * k + 0.03, k + 1, k, name, k + 1))
    if "mpm/mesh/heat" in text and not makes_points:
        grid = "fix grid all mpm/mesh around.msh frame total part cells\n"
    if "mpm/deform" in text:
        head = head.replace("f f f", "p p p")
        grid = grid.replace("\n", " frame total\n")
    if re.search("mpm/implicit (newmark|alpha|hht)", text):
        grid = grid.replace("\n", " transfer flip 1.0\n")
    if "mpm/incompressible" in text:    # has a lattice of its own, and no materials
        grid = "".join("group %s empty\n" % name for name in re.findall(r" liquid (\w+) ", text))
        for name in re.findall(r" solid (\w+)", text):    # points of it begin beside the fluid
            before += ("region organ block 0.07 0.08 0.02 0.05 0.02 0.05\ncreate_points 1 region organ spacing 0.005\n"
                       "group %s region organ\nfix soft %s mpm/material density 1000 neohookean 1 0.49\n" % (name, name))
    mixture = "mpm/mixture" in text and not makes_points
    if mixture:
        grid = "".join("group %s type %d\nfix %s %s mpm 0.01\n" % (name, k + 1, name, name)
                       for k, name in enumerate(("soil", "water")))
    if not makes_points and re.search(r"mpm/column|\bcolumn free\b", text):    # ground, and a column beside it
        grid = "group soil type 1\ngroup column type 2\nfix grid soil mpm 0.01\nfix far column mpm 0.01\n"
        before += ("region column block 0.07 0.08 0.02 0.05 0.02 0.05\ncreate_points 2 region column spacing 0.005\n"
                   "group soil type 1\ngroup column type 2\nregion east plane 0.05 0 0 -1 0 0\n")
        before += "" if "mpm/column" in text else "fix free all mpm/column far y\n"
    refined = re.search(r"mpm/refine (.*)", text) if not makes_points else None
    if refined:    # bodies side by side, each on a lattice of half the spacing
        grid = ""
        for k, name in enumerate(refined.group(1).split()):
            origin = 0.005 * (1 - 0.5 ** k)
            grid += "group %s type %d\nfix %s %s mpm %g origin %g %g %g\n" % (name, k + 1, name, name, 0.01 * 0.5 ** k, *[origin] * 3)
            before += ("region part%d block %g %g 0.06 0.08 0.06 0.08\ncreate_points %d region part%d ppc 2 fix %s\n"
                       "group %s type %d\n" % (k, 0.02 + 0.02 * k, 0.04 + 0.02 * k, k + 1, k, name, name, k + 1))
    if heat_contact:
        before += "fix touch all mpm/contact %s\n" % " ".join(named)
    material = "" if "mpm/material" in text or own_field and grid == "" else MATERIAL
    if "mpm/incompressible" in text:
        material = ""
    soils = re.findall(r"\bsoil (\w+) ", text) if "mpm/pore" in text else []
    if soils:
        material = MATERIAL.replace("default", soils[0]) + "".join(
            "group %s empty\n" % name + MATERIAL.replace("default all", "%s %s" % (name, name))
            for name in soils[1:])
    heats = re.search(r"mpm/(contact|boundary|rigid) .*\bheat\b", text)    # by friction
    if heats:
        before += "fix warm all mpm/heat\n"
    if "mpm/heat grains" in text:
        before += ("fix prop all property/atom temperature heatflow ghost yes\ngroup grains type 3\n"
                   "fix warm grains heat/flow constant 500\nfix sun grains add/heat constant 1.0\n")
    if heats or "mpm/heat" in text or "mpm/mesh/heat" in text:
        material = material.replace("\n", " thermal conducting 460 293 52\n")
    if mixture:
        before += ("create_points 2 region base spacing $(0.05*lx) share 0.4\n"
                   "group soil type 1\ngroup water type 2\n")
        material = ("fix ms soil mpm/material density 1590 linear 1.0e6 0.3\n"
                    "fix mw water mpm/material density 1000 eos linear 1.0e6\n")
    points = POINTS.replace("0.05*", "0.025*") if "gimp" in text else POINTS    # below a cell
    points = "" if makes_points or refined else points + "".join("group %s type 1\n" % g for g in GROUPS)
    if "mpm_geostatic" in text:
        before += "fix weight all gravity 9.81 vector 0 0 -1\n"
        points = points.replace("$(0.2*lx) $(0.5*lx)", "INF INF")
        points = points.replace("INF INF\n", "0 $(0.3*lz)\n")
        material = "fix default all mpm/material density 1600 linear 1.0e7 0.3\n"
    if re.search("mpm/immersed|lists grains", text):
        before += "group grains type 3\n"
    if "mpm/elements" in text:
        points = "create_points 2 mesh ring.msh move 0.05 0.05 0.05\ngroup ring type 2\n"
    cloth, sheet = " woven " in text, "mpm/sheet" in text
    if "ball.msh" in text or "mpm/airbag" in text or cloth or sheet:
        points = "create_points 1 mesh ball.msh scale 0.3 move 0.05 0.05 0.05 thickness 0.001\n"
        law = "woven 1.0e6 1.0e6 1.0e4" if " axes " in text else "neohookean 1.0e5 0.3"
        material = "" if cloth else "fix default all mpm/material density 1000 %s\n" % law
    if cloth:
        points += "group tent type 1\n"
    if sheet:
        grid = ""
        before += "fix skin all mpm/elements ball.msh thickness 0.001\nfix move all nve\n"
        text = re.sub("^(pair_style .*)", r"\1\npair_coeff * * 1.0", text)
    if on_one_mesh:
        points = ""
    own_grid = re.search(r"^fix\s+\S+\s+\S+\s+mpm/mesh\s+(\S+)", text, re.M)
    if own_grid:    # the mesh
        grid = ""
        points = "" if makes_points else "create_points 1 elements %s part cells\n" % own_grid.group(1)
        material = "" if "mpm/material" in text else MATERIAL
    if "mpm/airbag" in text:
        before += "fix skin all mpm/elements ball.msh thickness 0.001 compression no\n"
    scene = head + grid + points + material + before
    if with_grains:
        scene += GRAINS
    if "write_dump" in text:
        scene += "timestep 1.0e-7\nrun 0\n"
    scene += text + "\n"
    if pairs and "pair_coeff 1 2" not in text:
        scene += "pair_coeff 1 2 1.0e6\n"
    if own_field and grid == "":
        scene += FLUID if " smooth " in text else MATERIAL
    if cloth:
        scene += "fix skin all mpm/elements ball.msh thickness 0.001 axes 1 0 0 0 1 0\n"
    if "mpm/dt" not in text:
        scene += "timestep 1.0e-7\n"
    return scene + "run 2\n"


def crystal_for(lines):
    """A crystal of atoms that fills the box, and points where these have not the full weight."""
    zones = re.findall(r"zone x (\S+) (\S+)", lines[-1])
    low = high = "INF"
    for one, zero in zones:
        if float(zero) < float(one):
            low = one
        else:
            high = one
    return """
units           lj
boundary        f p p
atom_style      hybrid atomic mpm
region          box block 0 120 0 6.2 0 6.2
create_box      2 box
lattice         fcc 1.07395
create_atoms    1 box
group           atoms type 1
set             type 1 mass 1.0
mass            * 1.0
fix             grid all mpm 3.1 transfer flip 1.0
region          atoms block %s %s INF INF INF INF side out units box
create_points   2 region atoms ppc 2
group           points type 2
fix             solid points mpm/material density 1.07395 linear 57.35 0.363
%s
pair_style      lj/cut 2.5
pair_coeff      * * 1.0 1.0
neigh_modify    exclude type 2 2 exclude type 1 2
fix             move atoms nve
run             2
""" % (low, high, "\n".join(lines))


def ball_mesh():
    """Gmsh's file of an octahedron whose triangles are divided twice, on a sphere of radius 0.1."""
    nodes = [(1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1)]
    faces = [(a, b, c) if (a == 0) ^ (b == 2) ^ (c == 4) else (b, a, c) for a in (0, 1) for b in (2, 3) for c in (4, 5)]
    for _ in range(2):
        finer = []
        for face in faces:
            middles = []
            for k in range(3):
                m = [p + q for p, q in zip(nodes[face[k]], nodes[face[(k + 1) % 3]])]
                r = sum(c * c for c in m) ** 0.5
                m = tuple(round(c / r, 12) + 0.0 for c in m)
                if m not in nodes:
                    nodes.append(m)
                middles.append(nodes.index(m))
            finer += [(face[0], middles[0], middles[2]), (face[1], middles[1], middles[0]),
                      (face[2], middles[2], middles[1]), tuple(middles)]
        faces = finer
    return ("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n%d\n" % len(nodes) +
            "".join("%d %.12g %.12g %.12g\n" % ((k + 1,) + tuple(0.1 * c for c in x)) for k, x in enumerate(nodes)) +
            "$EndNodes\n$Elements\n%d\n" % len(faces) +
            "".join("%d 2 2 1 1 %d %d %d\n" % ((k + 1,) + tuple(i + 1 for i in f)) for k, f in enumerate(faces)) +
            "$EndElements\n")


def block_mesh(dim, low, size, names):
    """Gmsh's file of 4 x 2 (x 2) cells, a group named cells or as given, and their sides with names: {"xlo": name, ...}."""
    n = (4, 2, 2)
    edge = size / n[0]
    node = lambda i, j, k: (k * (n[1] + 1) + j) * (n[0] + 1) + i + 1
    nodes = [tuple(low + edge * c for c in (i, j)) + ((low + edge * k) if dim == 3 else 0.0,)
             for k in range(n[2] + 1 if dim == 3 else 1) for j in range(n[1] + 1) for i in range(n[0] + 1)]
    groups = sorted(set(names.values()))
    elements = []
    for k in range(n[2] if dim == 3 else 1):
        for j in range(n[1]):
            for i in range(n[0]):
                flat = [node(i, j, k), node(i + 1, j, k), node(i + 1, j + 1, k), node(i, j + 1, k)]
                all_nodes = flat + [m + (n[0] + 1) * (n[1] + 1) for m in flat] if dim == 3 else flat
                elements.append((5 if dim == 3 else 3, 1, all_nodes))
                sides = {"xlo": (i == 0, (0, 3, 7, 4)), "xhi": (i == n[0] - 1, (1, 2, 6, 5)),
                         "ylo": (j == 0, (0, 1, 5, 4)), "yhi": (j == n[1] - 1, (3, 2, 6, 7)),
                         "zlo": (k == 0, (0, 1, 2, 3)), "zhi": (k == n[2] - 1, (4, 5, 6, 7))}
                for side, (there, corners) in sides.items():
                    if there and side in names and (dim == 3 or side[0] != "z"):
                        used = [all_nodes[c] for c in corners[:2 if dim == 2 else 4]]
                        elements.append((3 if dim == 3 else 1, 2 + groups.index(names[side]), used))
    text = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n%d\n%d 1 \"cells\"\n" % (len(groups) + 1, dim)
    text += "".join('%d %d "%s"\n' % (dim - 1, k + 2, name) for k, name in enumerate(groups)) + "$EndPhysicalNames\n"
    text += "$Nodes\n%d\n" % len(nodes) + "".join("%d %.12g %.12g %.12g\n" % ((k + 1,) + x) for k, x in enumerate(nodes))
    text += "$EndNodes\n$Elements\n%d\n" % len(elements)
    return text + "".join("%d %d 2 %d 1 %s\n" % (k + 1, kind, tag, " ".join(map(str, used)))
                          for k, (kind, tag, used) in enumerate(elements)) + "$EndElements\n"


# meshes whose cells are the grid: dimension, lower corner, length, names of sides
GRIDS = {"plate.msh": (3, 0.01, 0.08, {"xlo": "left", "ylo": "bottom", "xhi": "right"}),
         "tube.msh": (3, 0.01, 0.08, {"ylo": "xz", "zlo": "yz", "xlo": "bore"}),
         "around.msh": (3, 0.01, 0.08, {"zlo": "bottom", "xlo": "sides", "xhi": "sides", "ylo": "sides", "yhi": "sides"}),
         "wide.msh": (3, 0.0, 0.2, {"zlo": "bottom"}),
         "space.msh": (2, 0.0, 4.2, {"ylo": "bottom", "xlo": "sides", "xhi": "sides"}),
         "bar.msh": (2, 0.0, 1.0, {"xlo": "left", "ylo": "bottom", "xhi": "right"})}


def write_files(folder, scene):
    """The files that these scenes read, with the mesh in units of the file or of the scene."""
    size = 10.0 if "scale" in scene else 0.01
    os.makedirs(os.path.join(folder, "out"), exist_ok=True)
    with open(os.path.join(folder, "ring.msh"), "w", encoding="ascii") as file:
        file.write(MESH_FILE % (size, size, size))
    with open(os.path.join(folder, "ball.msh"), "w", encoding="ascii") as file:
        file.write(ball_mesh())
    for name, about in GRIDS.items():
        with open(os.path.join(folder, name), "w", encoding="ascii") as file:
            file.write(block_mesh(*about))
    with open(os.path.join(folder, "tool.stl"), "w", encoding="ascii") as file:
        file.write(TOOL)
    with open(os.path.join(folder, "scan.stl"), "w", encoding="ascii") as file:
        file.write(SCAN)
    with open(os.path.join(folder, "terrain.stl"), "w", encoding="ascii") as file:
        file.write(TERRAIN)
    with open(os.path.join(folder, "valley.asc"), "w", encoding="ascii") as file:
        file.write("ncols 2\nnrows 2\nxllcorner 512299\nyllcorner 5100199\ncellsize 1\n0.02 0.01\n0.02 0.01\n")
    with open(os.path.join(folder, "hare.obj"), "w", encoding="ascii") as file:
        file.write("".join("v %d %d %d\n" % corner for corner in CORNERS) +
                   "".join("f %d %d %d\n" % tuple(k + 1 for k in face) for face in FACES))
    for name in ("elcentro.txt", "pressure.csv"):
        with open(os.path.join(folder, name), "w", encoding="ascii") as file:
            file.write("0.0 0.0\n0.01 2.0\n0.02 0.0\n".replace(" ", "," if name.endswith("csv") else " "))
    for name, content in IMAGES.items():
        with open(os.path.join(folder, name), "wb") as file:
            file.write(content)


def example_scenes(path):
    """(line, input) for each line under "Examples" of a page."""
    lines = examples(path)
    for k, line in enumerate(lines):
        if line.startswith("atom_style"):
            yield line, line + "\nregion b block 0 1 0 1 0 1\ncreate_box 1 b\n"
        else:
            yield line, scene_for(prerequisites(line, lines[:k]) + [line])


def complete_scenes(path):
    """The inputs that a page shows as a whole."""
    if os.path.basename(path)[:-4] in TASKS:
        return []
    return ["\n".join(lines) + "\n" for _, lines in blocks(path)
            if any(line.split()[0] == "units" for line in lines)]
