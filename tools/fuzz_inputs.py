# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
"""Inputs that go wrong, for fuzz.py: examples and scenes of the manual with random mistakes in them."""

import glob
import os
import re
import sys

ROOT = os.environ.get("MPM_ROOT", os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
sys.path.insert(0, os.path.join(ROOT, "unittest", "docs"))

import docs_scenes    # noqa: E402  (of unittest)
import fuzz_scenes    # noqa: E402

LONGEST_RUN = 40
# these take seconds for their first step, or need what is not in their folder
NOT_USED = {"ball-in-sand", "boulders-in-debris", "hopper", "impact-on-crystal", "own-material",
            "own-physics", "settling", "spinning-disk", "tyre-on-gravel"}
NUMBERS = ["0", "-1", "1", "2", "3", "0.5", "7", "100", "0.0", "-0.5", "1e-6", "1e308", "-1e308", "1e-308", "1e30",
            "-1e30", "1e-30", "1e10", "2147483647", "2147483648", "-2147483648", "4294967296",
            "9223372036854775807"]
NO_NUMBERS = ["nan", "inf", "-inf", "99999999999999999999", '""', "NULL", "INF", "EDGE", "v_nothing", "v_fuzz", "v_fuzz", "v_fuzzatoms", "c_nothing", "f_nothing", "grid", "all", "yes", "no", "none"]
FACTORS = [-1.0, 0.1, 0.5, 2.0, 10.0, 1.0 + 1e-15]
# what may come between two runs; %(fix)s and so on are IDs of the input
BETWEEN = [
    "unfix %(fix)s", "unfix %(fix)s", "unfix %(fix)s", "uncompute %(compute)s", "undump %(dump)s",
    "delete_atoms group %(group)s", "delete_atoms group all", "delete_atoms random fraction 0.5 yes all NULL 7",
    "group %(group)s delete", "group %(group)s clear", "group fuzz id 1:20\ngroup %(group)s intersect all fuzz",
    "group fuzz id 1:20\ndelete_atoms group fuzz", "region %(region)s delete", "variable %(variable)s delete",
    "reset_timestep 0", "reset_timestep 1000000", "reset_atoms id", "change_box all x scale 1.01 remap",
    "change_box all boundary s s s", "change_box all triclinic", "change_box all boundary p p p",
    "fix fuzzbal all balance 5 1.0 shift xyz 5 1.1", "balance 1.0 shift x 5 1.0", "run 0", "run 5 pre no",
    "run 5 post no", "run 3 every 1 \"run 0\"", "run 5 start 0 stop 1000", "run 5 upto", "write_restart fuzz.restart",
    "write_data fuzz.data", "write_dump all custom fuzz.dump id x y z",
    "write_dump all mpm/vtk fuzz.vtp", "write_dump all mpm/grid/vtk fuzz.vti", "clear", "clear\n%(again)s",
    "write_restart fuzz.restart\nclear\nread_restart fuzz.restart\n%(next)s",
    "write_restart fuzz.restart\nclear\nread_restart fuzz.restart remap\n%(next)s",
    "write_data fuzz.data\nclear\n%(head)s\nread_data fuzz.data\n%(next)s",
    "write_restart fuzz.restart\nclear\nread_restart fuzz.restart\n%(changed)s",
    "write_restart fuzz.restart\nclear\nread_restart fuzz.restart\n%(changed)s",
    "write_restart fuzz.restart\nclear\nread_restart fuzz.restart\n%(changed)s\nwrite_restart b.restart\nclear\nread_restart b.restart\n%(next)s",
    "write_data fuzz.data\nread_data fuzz.data add append", "replicate 2 1 1", "replicate 1 1 2",
    "displace_atoms all move 0.01 0.01 0", "displace_atoms all move 1e6 0 0", "displace_atoms all random 0.1 0.1 0 7",
    "velocity all set 0 0 0", "velocity all create 300 7", "velocity all set 1e6 0 0", "velocity all zero linear",
    "set group all type 1", "set group all type 2", "set group all mass 0", "set group all mass -1",
    "set group all diameter 1", "set group %(group)s density 1", "set group all vx nan", "set atom 1 x 1e300",
    "set atom 1 vx 1e100", "atom_modify sort 1 0.1", 
    "neigh_modify every 10 delay 10 check no", "neigh_modify once yes", "neighbor 0 bin", "neighbor 100 bin",
    "comm_modify cutoff 0.1", "comm_style tiled", "comm_style tiled\nbalance 1.0 rcb", 
    "minimize 0 0 5 5", "timestep 0", "timestep -1e-6", "timestep 1e30", "timestep 1e-300",
    "timestep $(dt*10)", "reset_timestep 0 time 1e300", "thermo 1", "thermo_style custom step %(refs)s",
    "thermo_modify lost warn", "thermo_modify norm yes", "lattice fcc 1.0",
    "create_atoms 1 random 10 7 NULL", "create_atoms 1 single 0 0 0", "create_box 1 %(region)s",
    "create_points 1 region %(region)s ppc 2", "create_points 1 box ppc 1 overlap yes",
    "create_points 1 region %(region)s ppc 2 overlap yes", "mass * 1", "fix fuzzn all nve", "fix fuzzg all gravity 9.81 vector 0 -1 0",
    "fix fuzzd all deform 1 x erate 0.1", "fix fuzzs all setforce 0 0 0", "fix fuzzf all addforce 1e300 0 0",
    "fix fuzzm all momentum 1 linear 1 1 1 angular", "fix fuzze all evaporate 1 10 %(region)s 7",
    "fix fuzza all adapt 1 atom mass v_fuzzatoms", "fix fuzzp all print 1 \"$(step)\"", "fix fuzzt all store/state 1 x",
    "fix fuzzh all halt 1 v_fuzz > 0", "fix fuzzv all ave/atom 1 1 1 vx", "fix fuzzw all wall/reflect xlo EDGE",
    "compute fuzzc all mpm/energy", "compute fuzzc all mpm/atom stress pressure", "compute fuzzc all mpm/error v_fuzz",
    "compute fuzzc all mpm/fragment", "compute fuzzc all mpm/fragment separable 0.5",
    "compute fuzzc all mpm/jintegral tip 1 1 direction 1 0 radius 0.5 2 inertia yes",
    "rerun fuzz.dump dump x y z", "read_dump fuzz.dump 0 x y z", 
    "pair_style none", "pair_style zero 1.0\npair_coeff * *", "suffix omp", "package omp 1", 
    "fix_modify %(fix)s energy yes virial yes", "fix_modify %(fix)s respa 1", "compute_modify %(compute)s dynamic yes",
    "dump_modify %(dump)s every 1", "dump fuzzd all mpm/vtk 1 fuzz.*.vtp", "dump fuzzd all mpm/grid/vtk 1 fuzz.*.vti",
    "timer full sync", "group %(group)s dynamic all every 1",
    "fix %(fix)s all nve", "%(line)s", "%(line)s", "%(line)s", "unfix %(fix)s\n%(line)s", "unfix %(fix)s\nrun 1\n%(line)s",
    "%(other)s", "%(other)s", "%(other)s", "%(other)s", "unfix %(fix)s\n%(other)s", "unfix %(fix)s\n%(other)s",
    "variable fuzz equal 1/0", "variable fuzz equal 1e308*10", "variable fuzz delete", "quit",
]
ENOUGH = """if "$(atoms) > %d" then "print 'FUZZ: $(atoms) points are too many'" quit"""
TRAILER = """
print "FUZZ: the end of the input"
write_dump all custom fuzz.state id type x y z vx vy vz fx fy fz modify format float %.17g
compute fuzzstate all mpm/atom pressure vonmises
write_dump all custom fuzz.stress id c_fuzzstate[*] modify format float %.17g
"""


class Input:
    """A name, the lines of an input, each a list of words, and files by name."""

    def __init__(self, name, text, files=None):
        self.name, self.files = name, dict(files or {})
        text = re.sub(r"&[ \t]*\n", " ", text)
        self.lines = [words for words in map(split, text.splitlines()) if words]

    def text(self, most=None):
        """The input, which may stop where there are too many points: one that is merely large takes long."""
        lines = []
        for words in self.lines:
            lines.append(" ".join(words))
            if most and words[0] in ("create_points", "create_atoms", "replicate", "read_data", "read_restart"):
                lines.append(ENOUGH % most)
        return "\n".join(lines) + "\n"

    def copy(self):
        other = Input(self.name, "", self.files)
        other.lines = [list(words) for words in self.lines]
        return other


def split(line):
    """Words of a line; quoted text and immediate variables are one each; comments are left out."""
    line = re.sub(r'^((?:[^"#]|"[^"]*")*)#.*$', r"\1", line)
    return re.findall(r'"[^"]*"|\$\((?:[^()]|\([^()]*\))*\)\S*|\S+', line)


def bases():
    """Inputs that are right: examples with short runs, scenes of the manual, composed scenes."""
    found = []
    for folder in sorted(glob.glob(os.path.join(ROOT, "examples", "*"))):
        name = os.path.basename(folder)
        if name not in NOT_USED:
            files = {os.path.basename(path): read(path) for ending in ("stl", "msh", "pgm", "nrrd")
                     for path in sorted(glob.glob(os.path.join(folder, "*." + ending)))}
            found.append(Input(name, read(os.path.join(folder, "in." + name)).decode(), files))
    for path in docs_scenes.pages():
        page = os.path.basename(path)[:-4]
        for line, text in docs_scenes.example_scenes(path):
            found.append(Input("%s: %s" % (page, line), text, docs_files(text)))
        for text in docs_scenes.complete_scenes(path):
            found.append(Input(page, text, docs_files(text)))
    for seed in range(60):
        scene = fuzz_scenes.Scene(seed)
        found.append(Input("scene %d" % seed, scene.first(), scene.files))
    for base in found:
        plain(base)
    return found


def docs_files(text):
    size = 10.0 if "scale" in text else 0.01
    files = {"ring.msh": (docs_scenes.MESH_FILE % (size, size, size)).encode(),
             "tool.stl": docs_scenes.TOOL.encode(), **docs_scenes.IMAGES}
    return {name: content for name, content in files.items() if re.sub("[0-9]+", "%04d", name) in text or name in text}


def read(path):
    with open(path, "rb") as file:
        return file.read()


def plain(base):
    """No loops, no pictures, files of materials as files of the input."""
    pictures = [words[1] for words in base.lines if words[0] == "dump" and len(words) > 3
                and words[3] in ("image", "movie")]
    base.lines = [words for words in base.lines if words[0] not in ("jump", "shell", "python", "include")
                  and not (words[0] in ("dump", "dump_modify") and words[1] in pictures)]
    base.lines.insert(0, ["variable", "fuzz", "equal", "1.0"])
    base.lines.insert(1, ["variable", "fuzzatoms", "atom", "id"])
    for words in base.lines:
        for word in words:
            path = os.path.join(ROOT, "potentials", word)
            if word.endswith(".mpm") and os.path.isfile(path):
                base.files[word] = read(path)
    shorten(base)


def shorten(base, longest=LONGEST_RUN):
    """Runs, and tables of mpm_point, that end soon."""
    for words in base.lines:
        for k, word in enumerate(words[:-1]):
            limit = longest if word == "run" and k == 0 else 2000 if word == "steps" else 0
            following = words[k + 1]
            if limit and (following.startswith("$") or is_number(following)
                          and float(following) > limit):
                words[k + 1] = str(limit)


def is_number(word):
    return re.match(r"^[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?$", word) is not None


def grammar():
    """(style, keyword, alternatives of its values) of the option tables of the manual."""
    found = []
    for path in sorted(glob.glob(os.path.join(ROOT, "doc", "src", "options", "*.inc"))):
        style = os.path.basename(path)[:-4].replace("fix_mpm_", "fix mpm/").replace("fix_mpm", "fix mpm")
        for line in read(path).decode().splitlines():
            match = re.match(r"^ +\*(\S+)\* values? = (.*)$", line)
            if match:
                ways = [way.split() for way in re.split(r" or |: ", match.group(2)) if way.strip()]
                found.append((style, match.group(1), ways))
    return found


class Mutator:
    """Makes mistakes in inputs; all choices come from the random numbers given."""

    def __init__(self):
        self.bases, self.grammar = bases(), grammar()
        self.words = sorted({word for base in self.bases for words in base.lines for word in words[1:]
                             if re.match(r"^[a-z/]+$", word)})
        self.package_lines = sorted({" ".join(words) for base in self.bases for words in base.lines
                                     if is_package(words)})
        self.simple = [self.number] * 6 + [self.factor] * 4 + [self.option] * 6 + [self.other_line] * 2 + [
            self.drop_word, self.double_word, self.swap_words, self.other_word, self.drop_line,
            self.double_line, self.swap_lines]
        self.kinds = self.simple + [self.between] * 12 + [self.file] * 4

    def make(self, random):
        """A new input with one to three mistakes."""
        base = random.choice(self.bases).copy()
        for _ in range(random.choice((1, 1, 1, 2, 3))):
            random.choice(self.kinds)(base, random)
        base.lines = [words for words in base.lines if words]
        shorten(base)
        return base

    def line(self, base, random):
        """Lines of the package are changed more often than others."""
        package = [words for words in base.lines if is_package(words)]
        chosen = package if package and random.random() < 0.75 else base.lines[2:] or base.lines
        return random.choice(chosen) if chosen else [""]

    def replace_number(self, base, random, new):
        """Numbers, now and then expressions and names."""
        words = self.line(base, random)
        right = is_number if random.random() < 0.9 else lambda word: re.search(r"\d", word)
        places = [k for k, word in enumerate(words) if k and right(word)]
        if places:
            k = random.choice(places)
            words[k] = new(words[k])

    def number(self, base, random):
        extremes = NUMBERS if random.random() < 0.85 else NUMBERS + NO_NUMBERS
        self.replace_number(base, random, lambda word: random.choice(extremes))

    def factor(self, base, random):
        factor = random.choice(FACTORS)
        self.replace_number(base, random, lambda word: "%.17g" % (factor * float(word))
                            if is_number(word) else word)

    def drop_word(self, base, random):
        words = self.line(base, random)
        del words[place(words, random)]
        base.lines = [words for words in base.lines if words]

    def double_word(self, base, random):
        words = self.line(base, random)
        k = place(words, random)
        words.insert(k, words[k])

    def swap_words(self, base, random):
        words = self.line(base, random)
        i, j = (place(words, random) for _ in range(2))
        words[i], words[j] = words[j], words[i]

    def other_word(self, base, random):
        words = self.line(base, random)
        words[place(words, random)] = random.choice(self.words)

    def option(self, base, random):
        """A keyword with values, of this style or now and then of another."""
        words = self.line(base, random)
        style = " ".join(words[:1] + words[3:4]) if words[0] in ("fix", "compute") else words[0]
        own = [entry for entry in self.grammar if entry[0] == style]
        _, keyword, ways = random.choice(own if own and random.random() < 0.8 else self.grammar)
        words.append(keyword)
        for value in random.choice(ways):
            literal = re.match(r"^\*(\S+)\*$", value)
            words.append(literal.group(1) if literal else random.choice(
                NUMBERS + NO_NUMBERS + ["%.3g" % random.uniform(0, 2), "%d" % random.randint(1, 5)] * 20))

    def drop_line(self, base, random):
        words = self.line(base, random)
        base.lines = [other for other in base.lines if other is not words]

    def double_line(self, base, random):
        words = list(self.line(base, random))
        base.lines.insert(random.randrange(len(base.lines) + 1), words)

    def swap_lines(self, base, random):
        i, j = (random.randrange(len(base.lines)) for _ in range(2))
        base.lines[i], base.lines[j] = base.lines[j], base.lines[i]

    def other_line(self, base, random):
        """One of another input, rather near the end, where all that it needs is there."""
        at = max(random.randrange(len(base.lines) + 1), random.randrange(len(base.lines) + 1))
        base.lines.insert(at, split(random.choice(self.package_lines)))

    def between(self, base, random):
        """Commands after the first run, and a run after them."""
        names = {"again": "\n".join(" ".join(words) for words in base.lines)}
        missing = []
        for kind in ("fix", "compute", "dump", "group", "region", "variable"):
            found = [words[1] for words in base.lines if words[0] == kind and len(words) > 1]
            if not found:
                missing.append("%(" + kind + ")s")
            names[kind] = random.choice(found or ["all"])
            if random.random() < 0.5:    # rather those of the package
                found = [words[1] for words in base.lines if words[0] == kind and is_package(words)]
                names[kind] = random.choice(found or [names[kind]])
        same = [words for words in base.lines if words[0] == "fix" and words[1:2] == [names["fix"]]]
        line = random.choice(same or base.lines)
        names["line"] = " ".join(line)
        names["other"] = self.changed([line], random)
        names["refs"] = "c_%(compute)s c_%(compute)s[1] f_%(fix)s f_%(fix)s[1]" % names
        made = ("create_", "read_", "units", "dimension", "boundary", "atom_", "run", "write_", "velocity",
                "processors", "set", "displace_atoms", "delete_", "newton", "package", "suffix")
        following = [words for words in base.lines if not words[0].startswith(made)]
        names["next"] = "\n".join(" ".join(words) for words in following)
        names["changed"] = self.changed(following, random)
        names["head"] = "\n".join(" ".join(words) for words in base.lines if words[0] in (
            "units", "dimension", "boundary", "atom_style", "newton", "neighbor", "comm_modify"))
        for _ in range(random.choice((1, 1, 2, 3))):
            possible = [commands for commands in BETWEEN if not any(name in commands for name in missing)]
            commands = (random.choice(possible) % names).splitlines()
            new = [words for words in map(split, commands + ["run %d" % random.choice((0, 1, 5, 20))]) if words]
            runs = [k for k, words in enumerate(base.lines) if words[0] == "run"]
            at = random.choice(runs) + 1 if runs else len(base.lines)
            if runs and random.random() < 0.2:
                at = random.randrange(len(base.lines) + 1)
            base.lines[at:at] = new

    def changed(self, lines, random):
        """Text of these lines with a mistake."""
        part = Input("", "")
        part.lines = [list(words) for words in lines]
        random.choice(self.simple)(part, random)
        return part.text().rstrip()

    def file(self, base, random):
        """A file that is cut or changed, or else another mistake."""
        if not base.files:
            return random.choice(self.simple)(base, random)
        name = random.choice(sorted(base.files))
        base.files[name] = broken(base.files[name], random)
        return None


def place(words, random):
    """Index of a word of a command, rarely that of its name."""
    return random.randrange(1 if len(words) > 1 and random.random() < 0.95 else 0, len(words))


def is_package(words):
    return any("mpm" in word for word in words) or words[0] in ("create_points", "mpm_point")


def broken(content, random):
    """Bytes of a file after an accident."""
    kind = random.randrange(9)
    if kind == 0:
        return content[:random.randrange(len(content) + 1)]
    if kind == 1:
        start = random.randrange(len(content) + 1)
        return content[:start] + content[start + random.choice((1, 10, 1000)):]
    if kind == 2:
        changed = bytearray(content)
        for _ in range(random.choice((1, 3, 30))):
            if changed:
                changed[random.randrange(len(changed))] = random.randrange(256)
        return bytes(changed)
    if kind == 3:
        return random.choice((b"", b"\n", b"\0" * 100, bytes(random.randrange(256) for _ in range(500)),
                              content.replace(b"\n", b"\r\n"), content.replace(b"\n", b" ")))
    lines = content.split(b"\n")
    i, j = (random.randrange(len(lines)) for _ in range(2))
    if kind == 4:
        del lines[i:i + random.choice((1, 2, 7))]
    elif kind == 5:
        lines.insert(i, lines[j])
    elif kind == 6:
        lines[i], lines[j] = lines[j], lines[i]
    else:    # numbers
        for _ in range(random.choice((1, 1, 5))):
            numbered = [k for k, line in enumerate(lines) if re.search(rb"\d", line)]
            if numbered:
                k = random.choice(numbered)
                words = lines[k].split(b" ")
                at = random.choice([n for n, word in enumerate(words) if re.search(rb"\d", word)])
                words[at] = random.choice((NUMBERS + NO_NUMBERS[:4])).encode()
                lines[k] = b" ".join(words)
    return b"\n".join(lines)
