// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: smoke
// mpi: 1

// Each stage says what it reads and writes: it writes nothing else, and reads what was written.

#include "mpm_lammps.h"

#include "base/mpm_find_fixes.h"
#include "field/mpm_plan.h"
#include "field/mpm_point_map.h"

#include <map>
#include <string_view>

using namespace MPM_TEST;
using Data = MPMStageData;

/** Hashes of the data of all fields. What the owners of stages keep themselves is not looked at. */
class Hashes {
 public:
  explicit Hashes(LAMMPS *lmp)
  {
    const Atom *atom = lmp->atom;
    const auto n = (std::size_t) atom->nlocal;
    add(Data::POSITION, atom->x[0], 3 * n);
    add(Data::VELOCITY, atom->v[0], 3 * n);
    add(Data::FORCE, atom->f[0], 3 * n);
    if (atom->torque_flag) add(Data::FORCE, atom->torque[0], 3 * n);
    add(Data::MASS, atom->rmass, n);
    const auto *const points = MPMPoints::get(lmp->atom);
    add(Data::DEFORMATION, points->F[0], 9 * n);
    add(Data::STRESS, points->tau[0], 6 * n);
    for (const auto *fix : find_fixes<FixMPMMaterial>(lmp))
      if (fix->nhistory) add(Data::HISTORY, fix->history[0], n * fix->nhistory);
    for (const auto *field : MPMField::all(lmp)) {
      if (field->affine) {
        add(Data::AFFINE, field->affine->rows(), n * field->affine->size());
        if (field->affine->Q)
          add(Data::AFFINE, field->affine->Q[0], n * MPM_NS::poly_size(field->lattice.dim));
      }
      auto &grid = const_cast<MPMField *>(field)->grid;
      add(Data::NODES, grid.nodes(), grid.nnodes() * grid.nreal);
      for (const auto &run : field->map->runs) {
        const double ends[3] = {(double) run.first, (double) run.last, (double) run.slot};
        add(Data::BLOCKS, ends, 3);
      }
    }
  }
  /** Names of what differs and is not in the data. */
  std::string differs(const Hashes &other, const Data &writes) const
  {
    std::string list;
    for (const auto &[name, value] : hash)
      if (!writes.has(name) && (!other.hash.count(name) || other.hash.at(name) != value))
        list += name + " ";
    return list;
  }

 private:
  std::map<std::string, std::size_t> hash;

  void add(Data::Name datum, const double *values, std::size_t n)
  {
    const std::string_view bytes((const char *) values, n * sizeof(double));
    hash[datum] = 31 * hash[datum] + std::hash<std::string_view>()(bytes);
  }
};

/** A scene, a part of which is its name. */
struct Named {
  std::string name, scene;
};

std::string in_plane(const std::string &mpm, const std::string &fixes,
                     const std::string &material = "density 1 neohookean 100 0.3")
{
  return plane("lj", "f f", "0 8 0 8", 1, 0.3) + "region body block 1 5 0 3 INF INF\n" +
      "fix grid all mpm 0.5 " + mpm + "\ncreate_points 1 region body ppc 2\n" +
      "fix m all mpm/material " + material + "\nfix floor all mpm/boundary ylo slip\n" +
      "velocity all set 0.1 -0.2 0\nfix g all gravity 0.1 vector 0 -1 0\ntimestep 0.002\n" + fixes +
      "compute e all mpm/energy\n";
}

/** Two bodies, or soil and water, in fields of their own. */
std::string two_fields(const std::string &fixes)
{
  return plane("lj", "f f", "0 8 0 8", 2, 0.3) + "group one empty\ngroup two empty\n" + fixes +
      "fix floor all mpm/boundary ylo slip\nfix g all gravity 0.2 vector 0 -1 0\n"
      "velocity two set 0.1 -0.2 0\ntimestep 0.002\n";
}

const std::string CONTACT = R"(
fix a one mpm 0.5
fix b two mpm 0.5
region low block 1 4 0 2 INF INF
region high block 1 4 2 4 INF INF
create_points 1 region low ppc 2 fix a group one
create_points 2 region high ppc 2 fix b group two
fix m all mpm/material density 1 neohookean 100 0.3
fix touch all mpm/contact a b
)";
const std::string MIXTURE = R"(
fix s one mpm 0.5
fix w two mpm 0.5
region heap block 1 3 0 2 INF INF
region pool block 3 6 0 2 INF INF
create_points 1 region heap ppc 2 fix s group one
create_points 2 region heap ppc 2 fix w group two share 0.5
create_points 2 region pool ppc 2 fix w group two
fix ms one mpm/material density 1.25 drucker/prager 200.0 0.3 30
fix mw two mpm/material density 1.0 eos tait 200.0 7
fix mix all mpm/mixture s w 2.5 0.01 drag gidaspow 0.1
)";
const std::string REFINED = R"(
fix a one mpm 0.5 frame total
fix b two mpm 0.25 frame total origin 0.125 0.125
fix body all mpm/refine a b
region fine block 1 3 0 2 INF INF
region coarse block 3 5 0 2 INF INF
create_points 1 region coarse ppc 2 fix a group one
create_points 2 region fine ppc 2 fix b group two
fix m all mpm/material density 1 neohookean 100 0.3
)";
const std::string CELL = R"(
fix grid all mpm 0.5 frame total
create_points 1 box ppc 2
fix m all mpm/material density 1 neohookean 100 0.3
fix cell all mpm/deform x erate 0.1 y stress 0
timestep 0.002
)";

const std::string SOIL = "density 2 linear 1e4 0.3";

std::vector<Named> scenes()
{
  std::vector<Named> list;
  for (const std::string scheme : {"usl", "usf", "musl", "usavg"})
    for (const std::string options :
         {"transfer apic shape quadratic", "transfer flip 0.99 shape linear",
          "transfer polypic shape quadratic", "transfer xpic 2 shape cubic",
          "transfer fmpm 2 shape quadratic", "shape cpdi transfer apic", "shape gimp transfer tpic",
          "locking fbar", "locking pressure", "frame total", "heat yes"})
      list.push_back({scheme + " " + options, in_plane("scheme " + scheme + " " + options, "")});
  list.push_back({"every", in_plane("every 3", "")});
  list.push_back({"heat",
                  in_plane("", "fix heat all mpm/heat xlo temperature 20\n",
                           "density 1 linear 100 0.3 thermal conducting 10 1 1 0.0")});
  list.push_back({"water",
                  in_plane("",
                           "fix w all mpm/pore 1e5 1 1 soil m 0.4 constant 0.01 free "
                           "pressure 0\ntimestep 1e-4\n",
                           SOIL)});
  list.push_back({"moving water",
                  in_plane("",
                           "fix w all mpm/pore 1e5 1 1 soil m 0.4 constant 0.01 "
                           "free pressure 0 formulation u-v-p\ntimestep 1e-4\n",
                           SOIL)});
  list.push_back({"relaxation", in_plane("", "fix rest all mpm/relax 1e-6\n")});
  list.push_back({"implicit", in_plane("", "fix solve all mpm/implicit static\ntimestep 1\n")});
  list.push_back(
      {"midpoint", in_plane("", "fix solve all mpm/implicit midpoint\ntimestep 0.01\n")});
  list.push_back({"implicit water",
                  in_plane("",
                           "fix w all mpm/pore 1e5 1 1 soil m 0.4 constant 0.01 free pressure 0\n"
                           "fix solve all mpm/implicit static\ntimestep 1\n",
                           SOIL)});
  list.push_back({"layers", in_plane("", "fix far all mpm/pml ylo 2\n")});
  list.push_back(
      {"dashpot",
       in_plane("", "region w plane 1 0 0 1 0 0\nfix far all mpm/dashpot region w 10 5\n")});
  list.push_back({"traction",
                  in_plane("",
                           "region e plane 5 0 0 -1 0 0\n"
                           "fix load all mpm/traction region e pressure 0.5\n")});
  list.push_back({"contact", two_fields(CONTACT)});
  list.push_back({"mixture", two_fields(MIXTURE)});
  list.push_back({"refined body", two_fields(REFINED)});
  list.push_back({"cell", plane("lj", "p p", "0 4 0 4", 1, 0.3) + CELL});
  return list;
}

TEST(Stages, WriteWhatTheySay)
{
  int count = 0;
  for (const auto &[name, text] : scenes()) {
    Scene run;
    const auto message = run.error(text + "run 1\n");
    const bool may_be_refused = name.rfind("us", 0) == 0 || name.rfind("musl", 0) == 0;
    if (!may_be_refused) EXPECT_EQ(message, "") << name;
    if (!message.empty()) continue;
    count++;
    auto *const plan = MPMField::all(run.lmp)[0]->plan;
    std::unique_ptr<Hashes> before;
    std::set<std::string> wrong, seen;
    // the plan is made anew at the start of a run, and observed from the first step on
    auto look = [&](const MPMPlan::Stage &stage, bool done) {
      auto now = std::make_unique<Hashes>(run.lmp);
      if (done) {
        const auto list = now->differs(*before, stage.writes);
        if (!list.empty()) wrong.insert(stage.name + ": " + list);
        seen.insert(stage.name);
      }
      before = std::move(now);
    };
    ASSERT_NE(plan, nullptr);
    run.lmp->update->nsteps = 0;
    plan->observe(look);
    for (int k = 0; k < 3; k++) plan->step();
    EXPECT_TRUE(wrong.empty()) << name << ": " << ::testing::PrintToString(wrong);
    EXPECT_GE(seen.size(), 5u) << name;
  }
  EXPECT_GE(count, 40);    // schemes refuse some options
}

TEST(Stages, ReadNodesThatWereWritten)
{
  for (const auto &[name, text] : scenes()) {
    Scene run;
    if (!run.error(text + "run 0\n").empty()) continue;
    bool written = false;
    for (const auto &stage : MPMField::all(run.lmp)[0]->plan->list()) {
      EXPECT_FALSE(stage.writes.list().empty()) << name << ": " << stage.name;
      if (stage.reads.has(Data::NODES)) EXPECT_TRUE(written) << name << ": " << stage.name;
      written = written || stage.writes.has(Data::NODES);
    }
  }
}

TEST(Stages, ArePrinted)
{
  Scene run(in_plane("plan yes", ""));
  const auto text = log_of(run, "run 1\n");
  for (const auto &stage : MPMField::all(run.lmp)[0]->plan->list())
    EXPECT_NE(text.find(stage.reads.text() + " -> " + stage.writes.text()), std::string::npos)
        << stage.name;
}
