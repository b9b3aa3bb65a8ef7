# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
#
# labels: plugin examples
# sanitize: no
"""A law from outside: examples/own-material is built and used in a LAMMPS with the package, and in a
stock LAMMPS after mpmplugin.so; plugins that do not fit are refused."""

import os

import mpm_testing as mt

SOURCES = os.path.join(mt.ROOT, "src", "MPM")
PLUGIN = os.environ.get("MPM_PLUGIN", "")
STOCK = os.environ.get("MPM_STOCK_LMP", "")
CXX = os.environ.get("CXX", "c++")

folder = mt.scratch_folder()
OWN = os.path.join(folder, "build", "ownplugin.so")

LAWS = "density 8930 eos quadratic 138.6257e9 274.479e9"


def run(text, name="in.test", executable=mt.LMP):
    return mt.lammps(folder, text, file=name, executable=executable,
                     environment={"LAMMPS_PLUGIN_PATH": ""})


def compile_plugin(name, text):
    """A plugin from a few lines of C++, in a hurry."""
    with open(os.path.join(folder, name + ".cpp"), "w") as file:
        file.write(text)
    library = os.path.join(folder, name + ".so")
    mt.ok(mt.run([CXX, "-std=c++17", "-O0", "-fPIC", "-shared", "-Wno-unknown-pragmas", "-I" + SOURCES,
                  name + ".cpp", "-o", library], folder))
    return library


def test_builds():
    mt.build_example("own-material", folder)
    assert os.path.exists(OWN)


def check_example(result):
    mt.ok(result)
    assert not mt.warnings(result.output), result.output
    assert "eos quadratic K=138625700000 K2=274479000000" in result.output, result.tail()
    own, shock = (mt.table(os.path.join(folder, name + ".table")) for name in ("quadratic", "shock"))
    for row, other in zip(own, shock):
        u = 1.0 / row["J"] - 1.0
        assert abs(row["pressure"] - u * (138.6257e9 + 274.479e9 * u)) < 1e-12 * 138.6257e9
        assert abs(row["pressure"] - other["pressure"]) <= 138.6257e9 * (3 * u ** 3 + 1e-6 * u)
        assert abs(row["stored"] - row["work"]) <= 2e-3 * row["work"]
        # rho0 c^2 = - J^2 dp/dJ
        assert abs(8930 * row["wavespeed"] ** 2 - (138.6257e9 + 2 * 274.479e9 * u)) < 1e-9 * 138.6257e9
    (names, rows), = [t for t in mt.thermo(result.output) if "c_e[11]" in t[0]]
    assert abs(float(rows[-1][names.index("c_e[11]")])) < 1e-9 * float(rows[0][3]), rows[-1]
    return rows


rows = {}


def test_runs():
    rows["in tree"] = check_example(mt.lammps(folder, file="in.own-material",
                                              environment={"LAMMPS_PLUGIN_PATH": ""}))


def test_after_the_plugin_of_the_package():
    if not os.path.exists(PLUGIN) or not os.path.exists(STOCK):
        raise mt.Skip("not built: '%s' '%s'" % (PLUGIN, STOCK))
    text = "plugin load %s\n" % PLUGIN + mt.read(os.path.join(folder, "in.own-material"))
    assert check_example(run(text, executable=STOCK)) == rows["in tree"]
    found = run("plugin load %s\n" % OWN, executable=STOCK)
    assert "undefined symbol" in found.output, found.tail()


def test_restart_and_loading_again():
    head = "plugin load %s\nunits si\natom_style mpm\n" % OWN
    scene = ("region b block 0 8 0 8 0 8\ncreate_box 1 b\nfix grid all mpm 1.0\n"
             "region o block 2 5 2 5 2 5\ncreate_points 1 region o ppc 2\n"
             "fix m all mpm/material %s\n" % LAWS)
    again = ("fix grid all mpm 1.0\nfix m all mpm/material %s\n" % LAWS)
    tail = "timestep 1e-5\nthermo 1\nthermo_style custom step ke press\nrun 5\n"
    found = mt.ok(run(head + "boundary f f f\nneighbor 0.3 bin\n" + scene + "velocity all set 100 0 0\n"
                "variable v atom -50*(x-3)\nvelocity all set v_v 0 0 sum yes\n" + tail +
                "write_restart own.restart\n" + tail + "clear\n" + head.split("\n")[0] +
                "\nread_restart own.restart\nneighbor 0.3 bin\n" + again + tail))
    a, b = mt.thermo(found.output)[-2:]
    assert a == b, (a, b)


def test_errors_of_its_parameters():
    found = run("units si\nplugin load %s\nmpm_point NULL shear 1 time 1 material density 1 "
                "eos quadratic 1e9 -3\n" % OWN)
    assert "eos quadratic: K2 = -3 (coefficient of the square) is out of range: 0 <= VALUE" \
        in found.output, found.tail()
    found = run("units si\nmpm_point NULL shear 1 time 1 material density 1 eos quadratic 1e9 3\n")
    assert "unknown eos 'quadratic': choose linear, shock, tait" in found.output, found.tail()


LAW = """
#include "law/plugin.h"
namespace MPM_NS::law {
namespace {
struct Own : LawDefaults {
  static constexpr const char *name = "%s", *meaning = "no stress";
  static constexpr Parameter parameters[] = {{"", "K", "pressure", POSITIVE, REQUIRED, "nothing"}};
  static void update(const LawParameters &, Batch &, History) {}
};
}
}
"""


def test_a_name_that_exists_is_refused():
    library = compile_plugin("shock", LAW % "shock" + "MPM_LAW_PLUGIN(MPM_LAW(EOS, Own))\n")
    found = run("plugin load %s\n" % library)
    assert found.code != 0 and "there is another law 'shock' already" in found.output, found.tail()
    library = compile_plugin("quadratic", LAW % "quadratic" + "MPM_LAW_PLUGIN(MPM_LAW(EOS, Own))\n")
    found = run("plugin load %s\nplugin load %s\n" % (OWN, library))
    assert found.code != 0 and "another law 'quadratic' already" in found.output, found.tail()
    # the same plugin twice is fine
    mt.ok(run("plugin load %s\nplugin load %s\n" % (OWN, OWN)))


def test_another_version_is_refused():
    library = compile_plugin("old", LAW % "old" + """
extern "C" void lammpsplugin_init(void *lmp, void *, void *)
{
  static const MPM_NS::PluginLaw laws[] = {MPM_LAW(EOS, Own)};
  MPM_NS::LawVersion version = MPM_NS::law_version;
  version.interface--;
  MPM_NS::register_laws(lmp, version, laws, 1);
}
""")
    found = run("plugin load %s\n" % library)
    assert found.code != 0 and "headers of another version of the MPM package" in found.output, \
        found.tail()


mt.main(globals())
