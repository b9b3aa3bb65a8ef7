// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

// labels: unit output smoke ranks
// mpi: 1 2

// Output styles: compute mpm/atom, compute mpm/energy, dump mpm/vtk, dump mpm/grid/vtk.

#include "mpm_lammps.h"

#include "grid2d.h"
#include "grid3d.h"
#include "output.h"
#include "output/mpm_vtk.h"

using namespace LAMMPS_NS;
using namespace MPM_NS;
using namespace MPM_TEST;
using State = Scene::State;

// ---------------------------------------------------------------- helpers

/** File names for this number of processes, since tests of both may run at the same time. */
static std::string name(const std::string &text)
{
  return "mpm_output_np" + std::to_string(nranks()) + "_" + text;
}

/** A text as VTK's XML files have it: a number for each character. */
static std::string codes_of(const std::string &text)
{
  std::string codes;
  for (const char c : text) codes += std::to_string((int) c) + " ";
  return codes;
}

/** Reads what VTKFile writes: attributes and appended arrays, as doubles. */
class VTKReader {
 public:
  struct Array {
    std::string type;
    int ncomponent;
    std::vector<double> value;
  };
  std::map<std::string, Array> array;
  std::string header;

  explicit VTKReader(const std::string &file)
  {
    const std::string text = file_text(file);
    const std::string mark = "<AppendedData encoding=\"raw\">\n_";
    const auto appended = text.find(mark);
    if (appended == std::string::npos) {
      ADD_FAILURE() << file << " has no appended data";
      return;
    }
    header = text.substr(0, appended);
    const std::size_t start = appended + mark.size();
    std::size_t end = start;
    for (auto at = header.find("<DataArray"); at != std::string::npos;
         at = header.find("<DataArray", at + 1)) {
      const std::string tag = header.substr(at, header.find('>', at) - at);
      if (attribute(tag, "format") != "appended") continue;
      Array a;
      a.type = attribute(tag, "type");
      a.ncomponent = std::stoi(attribute(tag, "NumberOfComponents"));
      std::size_t offset = start + std::stoul(attribute(tag, "offset"));
      EXPECT_EQ(offset, end) << "arrays follow each other";
      uint64_t bytes;
      memcpy(&bytes, &text[offset], 8);
      offset += 8;
      end = offset + bytes;
      if (a.type == "Float64")
        read<double>(text, offset, bytes, a.value);
      else if (a.type == "Float32")
        read<float>(text, offset, bytes, a.value);
      else if (a.type == "Int64")
        read<int64_t>(text, offset, bytes, a.value);
      else if (a.type == "UInt8")
        read<uint8_t>(text, offset, bytes, a.value);
      else
        ADD_FAILURE() << "unknown type " << a.type;
      array[attribute(tag, "Name")] = a;
    }
    EXPECT_EQ(text.substr(end), "\n</AppendedData>\n</VTKFile>\n");
  }

  long number(const std::string &key) const { return std::stol(attribute(header, key)); }
  double time() const
  {
    const auto at = header.find("Name=\"TimeValue\"");
    return std::stod(header.substr(header.find('>', at) + 1));
  }
  const std::vector<double> &operator[](const std::string &key)
  {
    EXPECT_EQ(array.count(key), 1u) << key;
    return array[key].value;
  }

 private:
  static std::string attribute(const std::string &tag, const std::string &key)
  {
    const auto at = tag.find(" " + key + "=\"");
    if (at == std::string::npos) return "";
    const auto from = at + key.size() + 3;
    return tag.substr(from, tag.find('"', from) - from);
  }
  template <typename T>
  static void read(const std::string &text, std::size_t at, uint64_t bytes, std::vector<double> &v)
  {
    for (uint64_t k = 0; k < bytes; k += sizeof(T)) {
      T value;
      memcpy(&value, &text[at + k], sizeof(T));
      v.push_back((double) value);
    }
  }
};

// ---------------------------------------------------------------- points with a state set by hand

/** Points 1 and 2: neo-Hookean, 3 and 4: elastic-plastic, atom 5: no point; also on two ranks. */
class ByHand : public ::testing::Test {
 protected:
  Scene run;
  std::vector<State> state;

  static constexpr double E = 10.0, NU = 0.25, RHO1 = 1.0, RHO2 = 2.0;

  void SetUp() override
  {
    run.commands(space("lj", "f f f", "0 8 0 8 0 8", 3) +
                 "create_atoms 1 single 1.3 2.2 3.1\ncreate_atoms 1 single 6.2 2.5 3.6\n"
                 "create_atoms 2 single 2.7 4.4 3.3\ncreate_atoms 2 single 6.9 4.1 3.8\n"
                 "create_atoms 3 single 3.5 6.0 6.0\nset type 1*2 volume 0.125\n"
                 "set type 1 mass 0.125\nset type 2 mass 0.25\ngroup points type 1 2\n"
                 "group one type 1\ngroup two type 2\nfix grid points mpm 1.0\n"
                 "fix m1 one mpm/material density 1.0 neohookean 10.0 0.25\n"
                 "fix m2 two mpm/material density 2.0 eos linear 20.0 strength j2 5.0 0.05 "
                 "hardening linear 0.5\n"
                 "timestep 1.0e-6\n");
  }

  /** Give all points a state that differs in all components. */
  void set_state()
  {
    auto *atom = run.lmp->atom;
    auto *points = MPMPoints::get(atom);
    auto *plastic = run.material("m2");
    const int eplastic = plastic->find_history("eplastic");
    ASSERT_GE(eplastic, 0);
    for (int i = 0; i < atom->nlocal; i++) {
      const double t = atom->tag[i];
      for (int c = 0; c < 9; c++) points->F[i][c] = (c % 4 == 0) + 0.01 * t * (c - 2);
      for (int c = 0; c < 6; c++) points->tau[i][c] = t * (c + 1) * (c % 2 ? 1.0 : -1.5);
      for (int d = 0; d < 3; d++) atom->v[i][d] = 1.0e-3 * t * (d + 1);
      if (atom->type[i] == 2) plastic->history[i][eplastic] = 0.5 * t;
    }
    state = run.gather();
  }

  /** Column n (0 for a vector) of a compute, by tag - 1, on all processes. */
  std::vector<double> column(const std::string &id, int n = 0)
  {
    auto *compute = run.per_atom(id);
    auto *atom = run.lmp->atom;
    std::vector<double> mine(atom->natoms, 0.0);
    for (int i = 0; i < atom->nlocal; i++)
      mine[atom->tag[i] - 1] = compute->size_peratom_cols ? compute->array_atom[i][n]
                                                          : compute->vector_atom[i];
    return over_ranks(mine);
  }
};

/** The sum over permutations: that of the package is what is tested here. */
static double det(const double *F)
{
  double sum = 0.0;
  for (int a = 0; a < 3; a++) {
    const int b = (a + 1) % 3, c = (a + 2) % 3;
    sum += F[a] * F[3 + b] * F[6 + c] - F[a] * F[3 + c] * F[6 + b];
  }
  return sum;
}

/** Each name alone gives a vector. */
TEST_F(ByHand, NamesGiveTheQuantities)
{
  const auto quantities = [](const State &p) {
    const double J = det(p.F), density = p.tag < 3 ? RHO1 : RHO2;
    std::vector<std::pair<std::string, double>> all = {{"J", J},
                                                       {"volume", 0.125 * J},
                                                       {"volume0", 0.125},
                                                       {"mass", 0.125 * density},
                                                       {"density", density / J},
                                                       {"pressure", p.pressure()},
                                                       {"speed", 1.0e-3 * p.tag * sqrt(14.0)},
                                                       {"eplastic", p.tag < 3 ? 0.0 : 0.5 * p.tag}};
    const char *axes[] = {"xx", "yy", "zz", "xy", "xz", "yz"};
    for (int c = 0; c < 6; c++) all.emplace_back(std::string("stress/") + axes[c], p.stress[c]);
    for (int c = 0; c < 9; c++)
      all.emplace_back(std::string("F/") + "xyz"[c / 3] + "xyz"[c % 3], p.F[c]);
    return all;
  };
  int n = 0;
  for (const auto &[name, value] : quantities(run.gather()[0]))
    run.commands("compute q_" + std::to_string(n++) + " all mpm/atom " + name + "\n");
  run.commands("run 0\n");
  set_state();
  for (const auto &p : state) {
    n = 0;
    for (const auto &[name, value] : quantities(p)) {
      const double found = column("q_" + std::to_string(n++))[(int) p.tag - 1];
      const double expected = p.tag == 5 ? 0.0 : value;
      EXPECT_NEAR(found, expected, 1.0e-14 * (1.0 + fabs(expected))) << name << " of " << p.tag;
    }
  }
}

/** Invariants of stress states whose values are known. */
TEST_F(ByHand, StressInvariants)
{
  run.commands("compute q all mpm/atom vonmises triaxiality principal/* pressure\nrun 0\n");
  set_state();
  auto *points = MPMPoints::get(run.lmp->atom);
  // uniaxial, hydrostatic, shear, and diag(1,2,6) turned by atan(3/4) about z
  const double c = 0.8, s = 0.6;
  const double stress[4][6] = {{-7, 0, 0, 0, 0, 0},
                               {3, 3, 3, 0, 0, 0},
                               {0, 0, 0, 0, 0, 5},
                               {c * c + 2 * s * s, s * s + 2 * c * c, 6, -c * s, 0, 0}};
  for (int i = 0; i < run.lmp->atom->nlocal; i++) {
    const int p = (int) run.lmp->atom->tag[i] - 1;
    if (p < 4)
      for (int k = 0; k < 6; k++) points->tau[i][k] = points->jacobian(i) * stress[p][k];
  }

  const double vonmises[] = {7, 0, 5 * sqrt(3.0), sqrt(21.0)};
  const double triaxiality[] = {-1.0 / 3.0, 0, 0, 3.0 / sqrt(21.0)};
  const double principal[3][4] = {{0, 3, 5, 6}, {0, 3, 0, 2}, {-7, 3, -5, 1}};
  const double pressure[] = {7.0 / 3.0, -3, 0, -3};
  for (int p = 0; p < 4; p++) {
    EXPECT_NEAR(column("q", 0)[p], vonmises[p], 1e-14 * 10);
    EXPECT_NEAR(column("q", 1)[p], triaxiality[p], 1e-14);
    for (int k = 0; k < 3; k++) EXPECT_NEAR(column("q", 2 + k)[p], principal[k][p], 1e-14 * 10);
    EXPECT_NEAR(column("q", 5)[p], pressure[p], 1e-14 * 10);
  }
}

TEST_F(ByHand, EnergyAndWaveSpeed)
{
  run.commands("compute q all mpm/atom energy wavespeed\ncompute one one mpm/atom energy\nrun 0\n");
  const double mu = E / (2 * (1 + NU)), lambda = E * NU / ((1 + NU) * (1 - 2 * NU));
  auto speed = column("q", 1);
  EXPECT_NEAR(speed[0], sqrt((lambda + 2 * mu) / RHO1), 1e-12);
  EXPECT_NEAR(speed[3], sqrt((20.0 + 4.0 / 3.0 * 5.0) / RHO2), 1e-12);
  EXPECT_EQ(speed[4], 0.0);

  set_state();
  const auto energy = column("q", 0), one = column("one");
  for (int p = 0; p < 2; p++) {
    const double *F = state[p].F;
    double trace = 0.0;
    for (int c = 0; c < 9; c++) trace += F[c] * F[c];
    const double log_J = log(det(F));
    const double w = 0.5 * mu * (trace - 3 - 2 * log_J) + 0.5 * lambda * log_J * log_J;
    EXPECT_NEAR(energy[p], 0.125 * w, 1e-14);
    EXPECT_EQ(one[p], energy[p]);
  }
  EXPECT_GT(energy[2], 0.0);
  EXPECT_EQ(energy[4], 0.0);
  EXPECT_EQ(one[2], 0.0) << "not in the group";
}

/** Wildcards, and what uses per-atom values: reduce, fix ave/atom, fix ave/grid, variables. */
TEST_F(ByHand, WorksWithOtherCommands)
{
  run.commands("compute q all mpm/atom stress/* F/* volume\ncompute v points mpm/atom volume\n"
               "compute sum points reduce sum c_q[16] c_v\nvariable twice atom 2*c_v\n"
               "compute most points reduce max v_twice\nfix mean points ave/atom 1 1 1 c_v c_q[1]\n"
               "fix cells points ave/grid 1 1 1 2 2 2 c_q[1] c_v norm all\n"
               "thermo_style custom step c_sum[*] c_most\nrun 0\n");
  EXPECT_EQ(run.lmp->modify->get_compute_by_id("q")->size_peratom_cols, 16);
  run.commands("run 2\n");
  const double expected = 4 * 0.125;
  EXPECT_NEAR(run.lmp->modify->get_compute_by_id("sum")->vector[0], expected, 1e-12);
  EXPECT_NEAR(run.lmp->modify->get_compute_by_id("sum")->vector[1], expected, 1e-12);
  EXPECT_NEAR(run.lmp->modify->get_compute_by_id("most")->scalar, 0.25, 1e-12);
}

TEST_F(ByHand, UnknownNamesAreRefused)
{
  expect_error(run, "compute q all mpm/atom\n", "compute mpm/atom");
  expect_error(run, "compute q all mpm/atom strain/*\n", "wildcards are F/*");

  // a history variable may come with a material that is defined later, so that run tells
  EXPECT_EQ(run.error("compute q all mpm/atom vonmises eplastik\n"), "");
  const auto text = run.error("run 0\n");
  EXPECT_THAT(text, HasSubstr("eplastik"));
  EXPECT_THAT(text, HasSubstr("vonmises"));
  EXPECT_THAT(text, HasSubstr("eplastic"));
}

TEST(Output, NeedsMaterialPoints)
{
  Scene run("region box block 0 8 0 8 0 8\ncreate_box 1 box\n");
  expect_error(run, "compute q all mpm/atom vonmises\n", "atom_style mpm");
}

// ---------------------------------------------------------------- dump mpm/vtk
TEST_F(ByHand, PointFile)
{
  run.commands("compute c all property/atom vx vy\ncompute one all mpm/atom vonmises\n"
               "variable v atom 10*id\nrun 0\n");
  set_state();
  run.commands("write_dump points mpm/vtk " + name("hand.vtp") +
               " stress F velocity vonmises eplastic volume c_c[*] c_one v_v image stress/xy "
               "modify sort id\n");
  MPI_Barrier(MPI_COMM_WORLD);
  if (rank() > 0) return;

  VTKReader file(name("hand.vtp"));
  EXPECT_THAT(file.header, HasSubstr("<VTKFile type=\"PolyData\""));
  EXPECT_THAT(file.header, HasSubstr("header_type=\"UInt64\""));
  EXPECT_EQ(file.number("NumberOfPoints"), 4);
  EXPECT_EQ(file.number("NumberOfVerts"), 4);
  EXPECT_THAT(file.header,
              HasSubstr("Name=\"Units\" NumberOfTuples=\"1\" format=\"ascii\">" +
                        codes_of(run.lmp->update->unit_style) + "0</Array>"));
  EXPECT_EQ(file.array["stress"].ncomponent, 9);
  EXPECT_EQ(file.array["F"].ncomponent, 9);
  EXPECT_EQ(file.array["velocity"].ncomponent, 3);
  EXPECT_EQ(file.array["c_c"].ncomponent, 2);
  EXPECT_EQ(file.array["id"].type, "Int64");
  EXPECT_EQ(file.array["type"].type, "Int64");
  EXPECT_EQ(file.array["image"].type, "Int64");
  EXPECT_EQ(file.array["stress"].type, "Float64");
  static const int tensor[] = {0, 3, 4, 3, 1, 5, 4, 5, 2};
  for (int p = 0; p < 4; p++) {
    const auto &s = state[p];
    EXPECT_EQ(file["id"][p], p + 1);
    EXPECT_EQ(file["type"][p], s.type);
    EXPECT_EQ(file["connectivity"][p], p);
    EXPECT_EQ(file["offsets"][p], p + 1);
    for (int d = 0; d < 3; d++) {
      EXPECT_EQ(file["Points"][3 * p + d], s.x[d]);
      EXPECT_EQ(file["velocity"][3 * p + d], s.v[d]);
      EXPECT_EQ(file["image"][3 * p + d], 0);
    }
    for (int c = 0; c < 9; c++) {
      EXPECT_EQ(file["F"][9 * p + c], s.F[c]);
      EXPECT_EQ(file["stress"][9 * p + c], s.stress[tensor[c]]);
    }
    EXPECT_EQ(file["c_c"][2 * p + 1], s.v[1]);
    EXPECT_EQ(file["stress/xy"][p], s.stress[3]);
    EXPECT_EQ(file["volume"][p], s.vol);
    EXPECT_EQ(file["eplastic"][p], p < 2 ? 0.0 : 0.5 * (p + 1));
    EXPECT_EQ(file["c_one"][p], file["vonmises"][p]);
    EXPECT_GT(file["vonmises"][p], 0.0);
    EXPECT_EQ(file["v_v"][p], 10.0 * (p + 1));
  }
  EXPECT_EQ(file_text(name("hand.pvd")), "");
  remove(name("hand.vtp").c_str());
}

/** Groups, regions, single precision, no points. */
TEST_F(ByHand, PointFileOptions)
{
  run.commands("region low block INF INF INF 3 INF INF\nregion empty block 0 0.1 0 0.1 0 0.1\n"
               "dump a one mpm/vtk 1 " +
               name("a.*.vtp") +
               " vonmises\ndump_modify a precision single sort id\ndump b all mpm/vtk 1 " +
               name("b.*.vtp") + "\ndump_modify b region low sort id\ndump c all mpm/vtk 1 " +
               name("c.*.vtp") + " J\ndump_modify c region empty\nrun 0\n");
  if (rank() == 0) {
    VTKReader a(name("a.0.vtp")), b(name("b.0.vtp")), c(name("c.0.vtp"));
    EXPECT_EQ(a["id"], (std::vector<double>{1, 2}));
    EXPECT_EQ(a.array["vonmises"].type, "Float32");
    EXPECT_EQ(a.array["Points"].type, "Float32");
    EXPECT_EQ(a.array["id"].type, "Int64");
    EXPECT_EQ((float) a["Points"][0], (float) 1.3);
    EXPECT_EQ(b["id"], (std::vector<double>{1, 2}));
    EXPECT_EQ(b["Points"][0], 1.3);
    EXPECT_EQ(c.number("NumberOfPoints"), 0);
    EXPECT_EQ(c["J"].size(), 0u);
    for (const char *which : {"a", "b", "c"}) {
      remove(name(std::string(which) + ".0.vtp").c_str());
      remove(name(std::string(which) + ".pvd").c_str());
    }
  }
}

TEST_F(ByHand, DumpErrors)
{
  auto dump = [&](const std::string &rest) {
    return run.error("dump d all mpm/vtk 10 " + rest + "\n");
  };
  EXPECT_THAT(dump("file.vtp vonmises"), HasSubstr("put a * into the file name, e.g. file.*.vtp"));
  EXPECT_THAT(dump("file.*.vtk vonmises"), HasSubstr("must end in .vtp"));
  EXPECT_THAT(dump("out%/file.*.vtp vonmises"), HasSubstr("% after the last /"));
  EXPECT_THAT(dump("out*/file.vtp vonmises"), HasSubstr("after the last /"));
  EXPECT_EQ(dump("*_%.vtp vonmises"), "");
  run.commands("undump d\n");
  EXPECT_THAT(run.error("write_dump all mpm/vtk out/%.vtp vonmises\n"),
              HasSubstr("more than % before .vtp"));
  EXPECT_THAT(dump("file.*.vtp element"), HasSubstr("use type instead"));
  EXPECT_THAT(dump("file.*.vtp c_nothing"), HasSubstr("nothing"));
  EXPECT_THAT(dump("file.*.vtp vonmises strain/*"), HasSubstr("strain/*"));
  EXPECT_EQ(run.lmp->modify->ncompute, 3) << "no compute is left behind (3 are those of thermo)";
  EXPECT_EQ(dump("file.*.vtp vonmises"), "");
  EXPECT_EQ(run.lmp->modify->ncompute, 4);
  expect_error(run, "dump_modify d precision half\n", "must be one of single double");
  run.commands("undump d\n");
  EXPECT_EQ(run.lmp->modify->ncompute, 3);

  EXPECT_EQ(run.error("dump d all mpm/vtk 1 " + name("x.*.vtp") + " vonmises eplastik\n"), "");
  expect_error(run, "run 0\n", "Unknown quantity eplastik in dump d of style mpm/vtk; known are:");
}

TEST(Output, CollectionNames)
{
  EXPECT_EQ(VTKCollection::list_name("bar.*.vtp", "d"), "bar.pvd");
  EXPECT_EQ(VTKCollection::list_name("a.b/bar_*.vtp", "d"), "a.b/bar.pvd");
  EXPECT_EQ(VTKCollection::list_name("out/*.vtp", "d"), "out/d.pvd");
  EXPECT_EQ(VTKCollection::list_name("*_x.vtp", "d"), "x.pvd");
  EXPECT_EQ(VTKCollection::list_name("bar.*.left.vtp", "d"), "bar.left.pvd");
  EXPECT_EQ(VTKCollection::list_name("bar.*.vtu", "d", ".grid"), "bar.grid.pvd");
  EXPECT_EQ(VTKCollection::list_name("bar.%.*.vtp", "d"), "bar.pvd");
  EXPECT_EQ(VTKCollection::list_name("out/bar-*-%.vtp", "d"), "out/bar.pvd");
  EXPECT_EQ(VTKCollection::list_name("%.*.vtp", "d"), "d.pvd");
}

// ---------------------------------------------------------------- a moving body
static const std::string scene = space("lj", "p f f", "0 8 0 8 0 8") +
    body("block 2.5 5.5 2 5 1.5 4.5", "density 1.0 neohookean 50.0 0.3") +
    "fix floor all mpm/boundary zlo slip\nfix pull all gravity 1.0 vector 0 0 -1\n"
    "velocity all set 0.7 0.1 -1.5\ntimestep 0.01\n";

/** Times in the list of files are physical, also when the time step changes between runs. */
TEST(Output, CollectionOfFiles)
{
  const std::string dump = "dump d all mpm/vtk 5 " + name("s.*.vtp");
  Scene run(scene + dump + " vonmises\ndump_modify d pad 4\nrun 10\ntimestep 0.005\nrun 10\n");
  MPI_Barrier(MPI_COMM_WORLD);
  std::string expected;
  const std::array<const char *, 2> files[] = {{"0", "0000"},
                                               {"0.050000000000000003", "0005"},
                                               {"0.10000000000000001", "0010"},
                                               {"0.125", "0015"},
                                               {"0.15000000000000002", "0020"}};
  for (const auto &[time, step] : files)
    expected += strprintf("<DataSet timestep=\"%s\" file=\"%s\"/>\n", time,
                          name(strprintf("s.%s.vtp", step)).c_str());
  if (rank() == 0) {
    EXPECT_THAT(file_text(name("s.pvd")), HasSubstr(expected));
    VTKReader last(name("s.0020.vtp"));
    EXPECT_NEAR(last.time(), 0.15, 1e-15);
    EXPECT_EQ(last.number("NumberOfPoints"), 216);
    EXPECT_EQ(last["Points"].size(), 648u);
  }

  // a new dump starts a new list, unless it is to append
  run.commands("undump d\n" + dump + "\ndump_modify d append yes pad 4\nrun 5\n");
  MPI_Barrier(MPI_COMM_WORLD);
  if (rank() == 0) { EXPECT_THAT(file_text(name("s.pvd")), HasSubstr(name("s.0015.vtp"))); }
  run.commands("undump d\n" + dump + "\ndump_modify d maxfiles 2 pad 4\nrun 10\n");
  MPI_Barrier(MPI_COMM_WORLD);
  if (rank() == 0) {
    const auto list = file_text(name("s.pvd"));
    EXPECT_EQ(list.find("s.0015.vtp"), std::string::npos);
    EXPECT_EQ(list.find("s.0025.vtp"), std::string::npos);
    EXPECT_THAT(list, HasSubstr("s.0030.vtp"));
    EXPECT_THAT(list, HasSubstr("s.0035.vtp"));
    EXPECT_EQ(file_text(name("s.0025.vtp")), "");
    for (int step = 0; step <= 35; step += 5) remove(name(strprintf("s.%04d.vtp", step)).c_str());
    remove(name("s.pvd").c_str());
  }
}

/** Every node once over all processes: mass and momentum are those of the points. */
TEST(Output, GridFile)
{
  Scene run(scene + "unfix pull\nunfix floor\ndump g all mpm/grid/vtk 20 " + name("g.*.vtu") +
            " grid mass velocity momentum index\nrun 20\n");
  const auto points = run.gather();
  MPI_Barrier(MPI_COMM_WORLD);
  if (rank() > 0) return;

  VTKReader file(name("g.20.vtu"));
  EXPECT_THAT(file.header, HasSubstr("<VTKFile type=\"UnstructuredGrid\""));
  const long nnode = file.number("NumberOfPoints"), ncell = file.number("NumberOfCells");
  ASSERT_EQ((long) file["mass"].size(), nnode);
  ASSERT_EQ((long) file["momentum"].size(), 3 * nnode);
  ASSERT_EQ((long) file["connectivity"].size(), 8 * ncell);
  ASSERT_GT(ncell, 27);
  double mass = 0.0, momentum[3] = {0, 0, 0};
  for (long n = 0; n < nnode; n++) {
    EXPECT_GT(file["mass"][n], 0.0);
    mass += file["mass"][n];
    for (int d = 0; d < 3; d++) {
      momentum[d] += file["momentum"][3 * n + d];
      const long k = 3 * n + d;
      EXPECT_NEAR(file["momentum"][k], file["mass"][n] * file["velocity"][k], 1e-15);
      EXPECT_EQ(file["Points"][k], file["index"][k]);    // origin 0, spacing 1
    }
  }
  const Totals expected(points);
  EXPECT_NEAR(mass, expected.mass, 1e-12 * expected.mass);
  for (int d = 0; d < 3; d++) EXPECT_NEAR(momentum[d], expected.p[d], 1e-12 * expected.mass);

  // cells are unit cubes with the corners in VTK's order
  static const int corner[8][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                                   {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
  for (long c = 0; c < ncell; c++) {
    EXPECT_EQ(file["types"][c], 12);
    EXPECT_EQ(file["offsets"][c], 8 * (c + 1));
    const long first = (long) file["connectivity"][8 * c];
    for (int k = 0; k < 8; k++)
      for (int d = 0; d < 3; d++)
        EXPECT_EQ(file["index"][3 * (long) file["connectivity"][8 * c + k] + d],
                  file["index"][3 * first + d] + corner[k][d]);
  }
  remove(name("g.0.vtu").c_str());
  remove(name("g.20.vtu").c_str());
  EXPECT_THAT(file_text(name("g.grid.pvd")), HasSubstr(name("g.20.vtu")));
  remove(name("g.grid.pvd").c_str());
}

TEST(Output, GridFileErrors)
{
  Scene run(scene);
  auto dump = [&](const std::string &rest) {
    return run.error("dump g " + rest + "\n");
  };
  EXPECT_THAT(dump("all mpm/grid/vtk 5 g.*.vtu nothing mass"), HasSubstr("nothing"));
  EXPECT_THAT(dump("all mpm/grid/vtk 5 g.*.vtu floor mass"), HasSubstr("not mpm"));
  EXPECT_THAT(dump("all mpm/grid/vtk 5 g.*.vtu grid stress"), HasSubstr("momentum"));
  EXPECT_THAT(dump("all mpm/grid/vtk 5 g.*.vti grid mass"), HasSubstr(".vtu"));
  EXPECT_THAT(dump("all mpm/grid/vtk 5 g.%.*.vtu grid mass"), HasSubstr("remove %"));
  EXPECT_THAT(dump("all mpm/grid/vtk 5 g.vtu grid mass"), HasSubstr("*"));
}

// between runs there can be other materials than in the last run, or none
SERIAL_TEST(Output, MaterialsAreThoseOfNow)
{
  const std::string other =
      "fix m all mpm/material density 1.0 eos linear 20.0 strength j2 5.0 0.05 "
      "hardening linear 0.5\n";
  const ScratchFile file("now.vtp");
  const auto dump = [&](const char *fields) {
    return "write_dump all mpm/vtk " + file.name + " " + fields + "\n";
  };
  const std::string gone = scene + "run 1\nunfix m\n";
  expect_error(gone + dump("energy"), "has no material: define a fix mpm/material");
  expect_error(gone + dump("eplastic"), "Unknown quantity eplastic");
  EXPECT_EQ(error_of(gone + other + dump("energy eplastic")), "");

  // a history variable that is gone
  Scene run(scene + "compute h all mpm/atom eplastic\nunfix m\n" + other + "run 1\n");
  auto *h = run.per_atom("h");
  run.commands("unfix m\nfix m all mpm/material density 1.0 neohookean 50.0 0.3\n");
  EXPECT_THROW(h->compute_peratom(), std::exception);
}

// ---------------------------------------------------------------- fix mpm/cells
static const std::string scene_2d = plane("lj", "p f", "0 8 0 6") +
    body("block 5.5 8 2 5 -0.5 0.5", "density 1.0 neohookean 50.0 0.3", "0.5") +
    "velocity all set 0.7 0.1 0\ntimestep 0.01\n";

/** Averages in cells by hand, also through fix ave/grid, which has a grid of its own. */
static void check_cells(const std::string &input, int dim, const int *n)
{
  const std::string size = strprintf("%d %d %d", n[0], n[1], n[2]);
  const std::string list = " f_cells:cell:density f_cells:cell:velocity[*] f_cells:cell:stress[*]"
                           " f_cells:cell:pressure f_cells:cell:fraction ";
  Scene run(input + "fix cells all mpm/cells grid\nfix mean all ave/grid 1 1 20 " + size + list +
            "\ndump cells all grid 20 " + name("cells.*.grid") + list + "\nrun 20\n");
  auto *lmp = run.lmp;
  auto *cells = lmp->modify->get_fix_by_id("cells");
  auto *mean = lmp->modify->get_fix_by_id("mean");

  int lo[3] = {0, 0, 0}, hi[3] = {0, 0, 0}, size_of_grid[3] = {1, 1, 1};
  if (dim == 3) {
    auto *grid = (Grid3d *) cells->get_grid_by_index(0);
    grid->get_bounds_owned(lo[0], hi[0], lo[1], hi[1], lo[2], hi[2]);
    grid->get_size(size_of_grid[0], size_of_grid[1], size_of_grid[2]);
  } else {
    auto *grid = (Grid2d *) cells->get_grid_by_index(0);
    grid->get_bounds_owned(lo[0], hi[0], lo[1], hi[1]);
    grid->get_size(size_of_grid[0], size_of_grid[1]);
  }
  for (int d = 0; d < dim; d++) EXPECT_EQ(size_of_grid[d], n[d]);

  // mass, momentum, volume, volume * stress of each cell
  std::vector<std::array<double, 11>> sum((std::size_t) n[0] * n[1] * n[2]);
  double volume = 1.0;
  for (int d = 0; d < dim; d++) volume *= lmp->domain->prd[d] / n[d];
  for (const auto &p : run.gather()) {
    int cell[3] = {0, 0, 0};
    for (int d = 0; d < dim; d++) {
      cell[d] = (int) floor((p.x[d] - lmp->domain->boxlo[d]) / lmp->domain->prd[d] * n[d]);
      cell[d] = (cell[d] + n[d]) % n[d];
    }
    auto &s = sum[((std::size_t) cell[2] * n[1] + cell[1]) * n[0] + cell[0]];
    s[0] += p.mass;
    for (int d = 0; d < 3; d++) s[1 + d] += p.mass * p.v[d];
    s[4] += p.vol;
    for (int c = 0; c < 6; c++) s[5 + c] += p.vol * p.stress[c];
  }

  const char *names[] = {"density", "velocity", "stress", "pressure", "fraction"};
  void *data[5];
  int column[5] = {0, 1, 4, 10, 11}, ncolumn[5];
  for (int k = 0; k < 5; k++) {
    const int index = cells->get_griddata_by_name(0, names[k], ncolumn[k]);
    ASSERT_GE(index, 0);
    data[k] = cells->get_griddata_by_index(index);
  }
  int other;
  EXPECT_EQ(cells->get_griddata_by_name(0, "temperature", other), -1);
  auto *all = mean->get_griddata_by_index(0);

  int filled = 0;
  for (int z = lo[2]; z <= hi[2]; z++)
    for (int y = lo[1]; y <= hi[1]; y++)
      for (int x = lo[0]; x <= hi[0]; x++) {
        const auto &s = sum[((std::size_t) z * n[1] + y) * n[0] + x];
        filled += s[0] > 0.0;
        double expected[12] = {0};
        if (s[0] > 0.0) {
          expected[0] = s[0] / volume;
          for (int d = 0; d < 3; d++) expected[1 + d] = s[1 + d] / s[0];
          for (int c = 0; c < 6; c++) expected[4 + c] = s[5 + c] / s[4];
          expected[10] = -(s[5] + s[6] + s[7]) / (3.0 * s[4]);
          expected[11] = s[4] / volume;
        }
        for (int k = 0; k < 5; k++)
          for (int c = 0; c < std::max(1, ncolumn[k]); c++) {
            const double found = ncolumn[k] == 0
                ? (dim == 2 ? ((double **) data[k])[y][x] : ((double ***) data[k])[z][y][x])
                : (dim == 2 ? ((double ***) data[k])[y][x][c]
                            : ((double ****) data[k])[z][y][x][c]);
            const double averaged = dim == 2 ? ((double ***) all)[y][x][column[k] + c]
                                             : ((double ****) all)[z][y][x][column[k] + c];
            EXPECT_NEAR(found, expected[column[k] + c], 1e-12) << names[k];
            EXPECT_EQ(found, averaged) << names[k];
          }
      }
  EXPECT_GT(over_ranks(filled), 20);
  MPI_Barrier(lmp->world);
  if (rank() == 0) {
    EXPECT_THAT(file_text(name("cells.20.grid")),
                HasSubstr("ITEM: GRID CELLS f_cells:cell:density"));
    for (const char *step : {"0", "20"})
      remove(name(std::string("cells.") + step + ".grid").c_str());
  }
}

TEST(Output, CellAverages)
{
  const int n[] = {8, 8, 8}, flat[] = {16, 12, 1};
  check_cells(scene, 3, n);
  check_cells(scene_2d, 2, flat);
  // the grid follows when load balancing moves the boundaries of processes
  check_cells(scene + "fix even all balance 5 1.0 shift x 10 1.0\n", 3, n);
}

TEST(Output, CellErrors)
{
  Scene run(scene);
  expect_error(run, "fix cells all mpm/cells\n", "mpm/cells");
  expect_error(run, "fix cells all mpm/cells floor\n", "needs a fix mpm");
  expect_error(run, "fix cells all mpm/cells grid density\n", "density");
}

struct Entry {
  /** Right-hand side of the balance. */
  static double gained(const double *v)
  {
    return v[EXTERNAL] + v[BOUNDARY] + v[CONTACT] + v[TRANSFER] + v[INTEGRATION];
  }
  enum { KINETIC, STORED, PLASTIC, VISCOUS };
  enum { EXTERNAL = 5, BOUNDARY, CONTACT, TRANSFER, INTEGRATION, RESIDUAL };
};

TEST(Energy, BalanceCloses)
{
  Scene run(scene +
            "compute e all mpm/energy\nthermo_style custom step c_e c_e[*]\nthermo 10\nrun 0\n");
  auto *e = run.lmp->modify->get_compute_by_id("e");
  const double start = e->compute_scalar();
  EXPECT_NEAR(start, 0.5 * 27.0 * (0.49 + 0.01 + 2.25), 1e-12);
  for (int k = Entry::EXTERNAL; k <= Entry::RESIDUAL; k++) EXPECT_EQ(e->vector[k], 0.0);

  double largest_stored = 0.0;
  for (int k = 0; k < 10; k++) {
    run.commands("run 20\n");
    const double total = e->compute_scalar();
    const double *v = e->vector;
    EXPECT_EQ(total, v[Entry::KINETIC] + v[Entry::STORED] + v[Entry::PLASTIC] + v[Entry::VISCOUS]);
    EXPECT_NEAR(v[Entry::RESIDUAL], 0.0, 1e-12 * start);
    EXPECT_NEAR(total - start, Entry::gained(v), 1e-12 * start);
    EXPECT_EQ(v[Entry::PLASTIC], 0.0);
    EXPECT_EQ(v[Entry::CONTACT], 0.0);
    EXPECT_LT(v[Entry::TRANSFER], 0.0);
    EXPECT_LE(v[Entry::BOUNDARY], 0.0);
    largest_stored = std::max(largest_stored, v[Entry::STORED]);
  }
  EXPECT_GT(largest_stored, 0.05 * start) << "the body hits the floor";
}

/** The error of time integration of a free body that oscillates vanishes with the time step. */
TEST(Energy, IntegrationErrorVanishesWithTheTimeStep)
{
  double error[2];
  for (int k = 0; k < 2; k++) {
    const int refine = k ? 4 : 1;
    Scene run(scene +
              "unfix floor\nunfix pull\nvelocity all ramp vz 2 -2 z 1.5 4.5\n"
              "compute e all mpm/energy\nthermo_style custom step c_e\n" +
              strprintf("timestep %g\nrun %d\n", 0.004 / refine, 60 * refine));
    const double *e = run.compute_vector();
    EXPECT_GT(e[Entry::STORED], 5.0);
    error[k] = e[Entry::INTEGRATION];
  }
  EXPECT_LT(fabs(error[1]), 0.35 * fabs(error[0]));
  EXPECT_LT(fabs(error[0]), 1.0);
}

TEST(Energy, StartsWithTheFirstRunAfterItsDefinition)
{
  Scene run(scene + "run 20\ncompute e all mpm/energy\nrun 0\n");
  auto *e = run.lmp->modify->get_compute_by_id("e");
  const double start = e->compute_scalar();
  run.commands("run 20\n");
  const double total = e->compute_scalar();
  EXPECT_NEAR(e->vector[Entry::RESIDUAL], 0.0, 1e-12 * start);
  EXPECT_NEAR(total - start, Entry::gained(e->vector), 1e-12 * start);
}

// a fix that is defined again has lost its part of the ledger
TEST(Energy, StartsAnewWhenAPartIsLost)
{
  for (const std::string again : {"fix grid all mpm 1.0 scheme musl\n",
                                  "fix m all mpm/material density 1.0 neohookean 50.0 0.3\n"}) {
    Scene run(scene + "compute e all mpm/energy\nthermo_style custom step c_e\nrun 40\n");
    auto *e = run.lmp->modify->get_compute_by_id("e");
    e->compute_vector();
    EXPECT_GT(std::abs(e->vector[Entry::EXTERNAL]), 1.0) << again;
    run.commands("unfix " + again.substr(4, again.find(' ', 4) - 4) + "\n" + again + "run 0\n");
    const double start = e->compute_scalar();
    for (int k = Entry::EXTERNAL; k <= Entry::RESIDUAL; k++) EXPECT_EQ(e->vector[k], 0.0) << again;
    run.commands("run 20\n");
    const double total = e->compute_scalar();
    EXPECT_NEAR(e->vector[Entry::RESIDUAL], 0.0, 1e-12 * start) << again;
    EXPECT_NEAR(total - start, Entry::gained(e->vector), 1e-12 * start) << again;
  }
}

TEST(Energy, Errors)
{
  Scene run(scene + "region left block 0 4 0 8 0 8\ngroup left region left\n");
  expect_error(run, "compute e left mpm/energy\n", "group all");
  expect_error(run, "compute e all mpm/energy kinetic\n", "kinetic");
  run.commands("compute e all mpm/energy\nunfix grid\n");
  expect_error(run, "run 0\n", "requires a fix mpm");
}
