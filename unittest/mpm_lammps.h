// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

#ifndef MPM_LAMMPS_TEST_H
#define MPM_LAMMPS_TEST_H

// A LAMMPS instance for tests, on any communicator: a rank may run its own serial reference next to
// a parallel run. This header includes the headers that nearly all tests need.

#include "atom.h"
#include "base/mpm_points.h"
#include "comm.h"
#include "compute.h"
#include "domain.h"
#include "exceptions.h"
#include "field/fix_mpm_material.h"
#include "field/mpm_affine.h"
#include "field/mpm_cpdi.h"
#include "field/mpm_every.h"
#include "field/mpm_field.h"
#include "field/mpm_frame.h"
#include "field/mpm_locking.h"
#include "field/mpm_node_sums.h"
#include "field/mpm_point_batches.h"
#include "field/mpm_time_limit.h"
#include "fix.h"
#include "fix_external.h"
#include "force.h"
#include "input.h"
#include "lammps.h"
#include "long_case.h"
#include "material/batch_kernels.h"
#include "material/material.h"
#include "modify.h"
#include "root_of.h"
#include "step/fix_mpm.h"
#include "update.h"
#include "variable.h"

#include "gmock/gmock.h"
#include "gtest/gtest.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <functional>
#include <map>
#include <memory>
#include <mpi.h>
#include <set>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace MPM_TEST {

using namespace LAMMPS_NS;
using ::testing::HasSubstr;
using ::testing::Values;
using ::testing::ValuesIn;

constexpr double PI = 3.14159265358979323846;

/** A test of results that do not depend on the number of ranks. It is skipped on more than one
 *  rank. */
#define SERIAL_TEST(suite, name)                            \
  static void suite##_##name();                             \
  TEST(suite, name)                                         \
  {                                                         \
    if (nranks() > 1) GTEST_SKIP() << "one rank is enough"; \
    suite##_##name();                                       \
  }                                                         \
  static void suite##_##name()

/** A test for each of the parameters that are given by Values(...) or ValuesIn(...). */
#define PARAMETER_TEST(suite, name, type, ...)            \
  class suite : public ::testing::TestWithParam<type> {}; \
  INSTANTIATE_TEST_SUITE_P(All, suite, __VA_ARGS__);      \
  TEST_P(suite, name)

/** The same on one rank only. */
#define SERIAL_PARAMETER_TEST(suite, name, type, ...)         \
  class suite : public ::testing::TestWithParam<type> {       \
    void SetUp() override                                     \
    {                                                         \
      if (nranks() > 1) GTEST_SKIP() << "one rank is enough"; \
    }                                                         \
  };                                                          \
  INSTANTIATE_TEST_SUITE_P(All, suite, __VA_ARGS__);          \
  TEST_P(suite, name)

inline int nranks(MPI_Comm comm = MPI_COMM_WORLD)
{
  int n;
  MPI_Comm_size(comm, &n);
  return n;
}

inline int rank(MPI_Comm comm = MPI_COMM_WORLD)
{
  int me;
  MPI_Comm_rank(comm, &me);
  return me;
}

/** Values reduced over all ranks, by default to their sums. */
inline std::vector<double> over_ranks(std::vector<double> values, MPI_Op op = MPI_SUM,
                                      MPI_Comm comm = MPI_COMM_WORLD)
{
  MPI_Allreduce(MPI_IN_PLACE, values.data(), (int) values.size(), MPI_DOUBLE, op, comm);
  return values;
}
inline double over_ranks(double value, MPI_Op op = MPI_SUM)
{
  return over_ranks(std::vector<double>{value}, op)[0];
}

/** The rows of all ranks, in order of ranks. */
template <class T> std::vector<T> all_rows(const std::vector<T> &mine, MPI_Comm comm)
{
  int bytes = mine.size() * sizeof(T);
  std::vector<int> counts(nranks(comm)), displs(counts.size(), 0);
  MPI_Allgather(&bytes, 1, MPI_INT, counts.data(), 1, MPI_INT, comm);
  for (std::size_t p = 1; p < counts.size(); p++) displs[p] = displs[p - 1] + counts[p - 1];
  std::vector<T> all((displs.back() + counts.back()) / sizeof(T));
  MPI_Allgatherv(mine.data(), bytes, MPI_BYTE, all.data(), counts.data(), displs.data(), MPI_BYTE,
                 comm);
  return all;
}

/** The same, sorted by tag. */
template <class T> std::vector<T> all_by_tag(const std::vector<T> &mine, MPI_Comm comm)
{
  auto all = all_rows(mine, comm);
  std::sort(all.begin(), all.end(), [](const T &a, const T &b) {
    return a.tag < b.tag;
  });
  return all;
}

/** A file that is removed at the end of a test at the latest. All ranks wait when it is written and
 *  removed. Its name begins with the source file of the test and the number of ranks, since tests
 *  may run at the same time. */
struct ScratchFile {
  const std::string name;

  explicit ScratchFile(const std::string &base, MPI_Comm comm = MPI_COMM_WORLD) :
      name(source() + ".np" + std::to_string(nranks()) + "." + base), comm(comm)
  {
  }
  ScratchFile(const std::string &base, const std::string &text, MPI_Comm comm = MPI_COMM_WORLD) :
      ScratchFile(base, comm)
  {
    if (rank(comm) == 0) {
      FILE *fp = fopen(name.c_str(), "wb");
      fwrite(text.data(), 1, text.size(), fp);
      fclose(fp);
    }
    MPI_Barrier(comm);
  }
  ~ScratchFile()
  {
    MPI_Barrier(comm);
    if (rank(comm) == 0) remove(name.c_str());
    MPI_Barrier(comm);
  }
  ScratchFile(const ScratchFile &) = delete;
  ScratchFile &operator=(const ScratchFile &) = delete;

 private:
  MPI_Comm comm;
  static std::string source()
  {
    const std::string file = ::testing::UnitTest::GetInstance()->current_test_info()->file();
    const auto start = file.rfind('/') + 1;    // 0 if there is no slash
    return file.substr(start, file.rfind('.') - start);
  }
};

/** The contents of a file; empty if it does not exist. */
inline std::string file_text(const std::string &name)
{
  std::ifstream file(name, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/** The text that printf would print. */
template <class... Args> std::string strprintf(const char *text, Args... args)
{
  std::vector<char> buffer(snprintf(nullptr, 0, text, args...) + 1);
  snprintf(buffer.data(), buffer.size(), text, args...);
  return buffer.data();
}

/** The scene with all occurrences of the word replaced by the text. */
inline std::string replaced(std::string scene, const std::string &word, const std::string &text)
{
  for (std::size_t at = 0; (at = scene.find(word, at)) != std::string::npos; at += text.size())
    scene.replace(at, word.size(), text);
  return scene;
}

/** The scene with the first word of each pair replaced by the second one, in this order. */
inline std::string replaced(std::string scene,
                            const std::vector<std::pair<std::string, std::string>> &changes)
{
  for (const auto &[word, text] : changes) scene = replaced(std::move(scene), word, text);
  return scene;
}

/** The first lines of a scene: a box, and material points as atoms. faces: "f f f"; extent: "xlo
 *  xhi ylo yhi zlo zhi"; types: number of atom types; skin: of neighbor lists, 0: the default of
 *  LAMMPS. */
inline std::string space(const std::string &units, const std::string &faces,
                         const std::string &extent, int types = 1, double skin = 0.0, int dim = 3)
{
  return strprintf("units %s\ndimension %d\nboundary %s\natom_style mpm\n", units.c_str(), dim,
                   faces.c_str()) +
      (skin > 0.0 ? strprintf("neighbor %.17g bin\n", skin) : "") +
      strprintf("region box block %s\ncreate_box %d box\n", extent.c_str(), types);
}

/** The same in 2d, periodic along z. faces: "f f"; extent: "xlo xhi ylo yhi", and zlo and zhi for
 *  another thickness than from -0.5 to 0.5. */
inline std::string plane(const std::string &units, const std::string &faces, std::string extent,
                         int types = 1, double skin = 0.0)
{
  if (std::count(extent.begin(), extent.end(), ' ') == 3) extent += " -0.5 0.5";
  return space(units, faces + " p", extent, types, skin, 2);
}

/** The same in 3d or 2d. faces and extent are those of 3d; the parts along z are left out in 2d. */
inline std::string box(int dim, const std::string &units, const std::string &faces,
                       std::string extent, int types = 1, double skin = 0.0)
{
  if (dim == 3) return space(units, faces, extent, types, skin);
  std::size_t end = 0;
  for (int word = 0; word < 4; word++) end = extent.find(' ', end + 1);
  return plane(units, faces.substr(0, 3), extent.substr(0, end), types, skin);
}

/** The usual next lines: a lattice, and one body of one material, in the region body (region "box":
 *  it fills the box). grid: node spacing and options of fix mpm. The IDs of the fixes are grid and
 *  m. */
inline std::string body(const std::string &region, const std::string &material,
                        const std::string &grid = "1.0", const std::string &ppc = "2")
{
  const bool fills = region == "box";
  return "fix grid all mpm " + grid + "\n" + (fills ? "" : "region body " + region + "\n") +
      "create_points 1 " + (fills ? "box" : "region body") + " ppc " + ppc + "\n" +
      "fix m all mpm/material " + material + "\n";
}

/** The lines of a scene that a run which continues from its restart file gives again. more: other
 *  commands that it gives. */
inline std::string lines_again(const std::string &scene, std::vector<std::string> more = {})
{
  std::string found;
  more.insert(more.end(),
              {"neighbor", "comm_modify", "region", "variable", "compute", "fix", "thermo_style",
               "timestep"});
  for (std::size_t at = 0, end; at < scene.size(); at = end + 1) {
    end = std::min(scene.find('\n', at), scene.size());
    const std::string line = scene.substr(at, end - at);
    for (const auto &word : more)
      if (line.compare(0, word.size() + 1, word + " ") == 0 &&
          line.compare(0, 11, "region box ") != 0)
        found += line + "\n";
  }
  return found;
}

/** A body of points. region: arguments of the region command; region and group have its name.
 *  lattice: spacing and options of its fix mpm. */
struct Body {
  std::string name, region, lattice = "";
};

/** Creates bodies of types 1, 2, .... sites: options of create_points, in which # stands for the
 *  type. */
inline std::string bodies(const std::vector<Body> &all, const std::string &sites = "ppc 2")
{
  std::string text;
  for (const auto &body : all) {
    const auto type = std::to_string(&body - all.data() + 1);
    text += "region " + body.name + " " + body.region + "\ncreate_points " + type + " region " +
        body.name + " " + replaced(sites, "#", type) + "\ngroup " + body.name + " type " + type +
        "\n";
  }
  return text;
}

/** Creates bodies of types 1, 2, ..., each in a field of its own, with the fixes F1, F2, ....
 *  lattice: for the bodies that have none. */
inline std::string fields(const std::vector<Body> &all, const std::string &lattice = "1.0")
{
  std::string fixes;
  for (const auto &body : all) {
    const auto type = std::to_string(&body - all.data() + 1);
    fixes += "group " + body.name + " type " + type + "\nfix F" + type + " " + body.name + " mpm " +
        (body.lattice.empty() ? lattice : body.lattice) + "\n";
  }
  return fixes + bodies(all, "ppc 2 fix F#");
}

/** A LAMMPS instance that a test drives. (::testing::Test has a member Run, hence another name.) */
class Scene {
 public:
  LAMMPS *lmp;

  explicit Scene(MPI_Comm comm = MPI_COMM_WORLD)
  {
    const char *args[] = {"mpm_test", "-log", "none", "-screen", "none", "-nocite"};
    lmp = new LAMMPS(6, const_cast<char **>(args), comm);
  }
  explicit Scene(const std::string &text, MPI_Comm comm = MPI_COMM_WORLD) : Scene(comm)
  {
    commands(text);
  }
  ~Scene() { delete lmp; }
  Scene(const Scene &) = delete;
  Scene &operator=(const Scene &) = delete;

  /** Executes lines of input. As in a script, & at the end of a line continues it. */
  void commands(const std::string &text)
  {
    std::string line;
    for (std::size_t at = 0, end; at < text.size(); at = end + 1) {
      end = std::min(text.find('\n', at), text.size());
      line += text.substr(at, end - at);
      if (!line.empty() && line.back() == '&') {
        line.pop_back();
        continue;
      }
      if (!line.empty()) execute(line);
      line.clear();
    }
  }

  /** Executes lines of input, and returns the message of their error on all ranks; empty: no
   *  error. */
  std::string error(const std::string &text)
  {
    expected = true;
    std::string message;
    try {
      commands(text);
    } catch (const std::exception &e) {
      message = e.what();
    }
    expected = false;
    return message;
  }

  /** The first n values of the vector of a fix, valid until the next call. */
  double *fix_vector(const std::string &id, int n)
  {
    values.resize(n);
    auto *fix = lmp->modify->get_fix_by_id(id);
    for (int k = 0; k < n; k++) values[k] = fix->compute_vector(k);
    return values.data();
  }
  double variable(const std::string &name)
  {
    return lmp->input->variable->compute_equal(lmp->input->variable->find(name.c_str()));
  }
  /** Evaluates an equal-style formula. Computes in it must be current, as after run 0. */
  double evaluate(const std::string &formula)
  {
    return lmp->input->variable->compute_equal(formula);
  }

  /** The vector of a compute, by default of the one with the ID e, mostly a compute mpm/energy. */
  const double *compute_vector(const std::string &id = "e")
  {
    auto *compute = lmp->modify->get_compute_by_id(id);
    compute->compute_vector();
    return compute->vector;
  }
  double compute_scalar(const std::string &id = "e")
  {
    return lmp->modify->get_compute_by_id(id)->compute_scalar();
  }

  /** A compute of values for atoms, which are current. */
  Compute *per_atom(const std::string &id)
  {
    auto *compute = lmp->modify->get_compute_by_id(id);
    compute->compute_peratom();
    return compute;
  }

  /** State of one point: unwrapped position, Cauchy stress, current volume. */
  struct State {
    double tag, type, x[3], v[3], F[9], stress[6], vol, mass;
    double pressure() const { return -(stress[0] + stress[1] + stress[2]) / 3.0; }
  };
  /** States of the points of all ranks, on all ranks, in order of tags. */
  std::vector<State> gather()
  {
    auto *atom = lmp->atom;
    auto *points = MPMPoints::get(atom);
    std::vector<State> mine(atom->nlocal);
    for (int i = 0; i < atom->nlocal; i++) {
      State &s = mine[i];
      s.tag = atom->tag[i];
      s.type = atom->type[i];
      double x[3] = {atom->x[i][0], atom->x[i][1], atom->x[i][2]};
      imageint image = atom->image[i];
      lmp->domain->remap(x, image);
      lmp->domain->unmap(x, image, s.x);
      for (int d = 0; d < 3; d++) s.v[d] = atom->v[i][d];
      for (int c = 0; c < 9; c++) s.F[c] = points->F[i][c];
      points->cauchy(i, s.stress);
      s.vol = points->jacobian(i) * atom->vfrac[i];
      s.mass = atom->rmass[i];
    }
    return all_by_tag(mine, lmp->world);
  }

  // the following members know only the points and nodes of this rank

  /** Calls f after the forces of each step, also of step 0. Positions, velocities, and stresses
   *  belong to that time. f may write a force to force[i], which is zero before; it acts in the
   *  next step. every: calls f only at multiples of this number of steps (for output, not for
   *  forces). Call this once, after the box is created. */
  void each_step(std::function<void(double **force)> f, int every = 1)
  {
    callback = f;
    commands("fix each_step all external pf/callback " + std::to_string(every) + " 1\n");
    dynamic_cast<FixExternal *>(lmp->modify->get_fix_by_id("each_step"))
        ->set_callback(
            [](void *self, bigint, int n, tagint *, double **, double **force) {
              if (n) std::fill(force[0], force[0] + 3 * n, 0.0);
              static_cast<Scene *>(self)->callback(force);
            },
            this);
  }

  double time() const
  {
    return lmp->update->atime + (lmp->update->ntimestep - lmp->update->atimestep) * lmp->update->dt;
  }
  int n() const { return lmp->atom->nlocal; }
  double **x() { return lmp->atom->x; }
  double **v() { return lmp->atom->v; }
  double *mass() { return lmp->atom->rmass; }
  MPMPoints &points() { return *MPMPoints::get(lmp->atom); }
  /** Cauchy stress of point i of this rank: xx yy zz xy xz yz. */
  std::array<double, 6> cauchy(int i)
  {
    std::array<double, 6> stress;
    points().cauchy(i, stress.data());
    return stress;
  }
  template <class T = Fix> T *fix(const std::string &id)
  {
    return dynamic_cast<T *>(lmp->modify->get_fix_by_id(id));
  }
  FixMPMMaterial *material(const std::string &id = "m") { return fix<FixMPMMaterial>(id); }

  // access of the tests to a field: only the members below know the members of fix mpm
  std::vector<std::string> fields()
  {
    std::vector<std::string> ids;
    for (auto *one : lmp->modify->get_fix_by_style("^mpm$")) ids.push_back(one->id);
    return ids;
  }
  int dim() { return lmp->domain->dimension; }
  double spacing(const std::string &id = "grid") { return field(id)->lattice.h; }
  bool is_point(int i, const std::string &id = "grid") { return field(id)->is_point(i); }
  /** C[dim*j+i] = d v_i / d x_j of APIC for each point; null if the field has none. */
  MPMRows affine(const std::string &id = "grid")
  {
    return field(id)->affine ? field(id)->affine->C : MPMRows();
  }
  /** Bilinear modes of PolyPIC; null if the field has none. */
  MPMRows modes(const std::string &id = "grid")
  {
    return field(id)->affine ? field(id)->affine->Q : MPMRows();
  }
  /** Corners of CPDI2 domains relative to the point; null if the field has none. */
  MPMRows corners(const std::string &id = "grid")
  {
    return field(id)->domains ? field(id)->domains->corners : MPMRows();
  }
  /** Reference positions, and F at the last update of the reference (total frame only). */
  MPMRows reference_positions() { return total_frame().X; }
  MPMRows reference_F() { return total_frame().R; }
  /** Displacement of point i along axis d since the last step of the cycle of keyword every. */
  double waiting(int i, int d, const std::string &id = "grid")
  {
    return field(id)->every ? field(id)->every->displacement(i, d) : 0.0;
  }
  /** This rank's stable time step. tag, wave_speed: receive those of the point that limits it. */
  double stable_dt(tagint *tag = nullptr, double *wave_speed = nullptr)
  {
    tagint whose;
    double c;
    return field()->time_limit->stable_dt(tag ? *tag : whose, wave_speed ? *wave_speed : c);
  }
  /** The share of the volume around each point that is filled with points. */
  std::vector<double> volume_shares()
  {
    std::vector<double> share;
    volume_at_points(*field(), share);
    return share;
  }
  /** Work of the walls on this rank. */
  double work_of_boundaries() { return field()->ledger.boundary; }
  /** Switches off the cure of volumetric locking from the next run on. (A new fix mpm would lose
   *  the reference configuration.) */
  void switch_locking_off()
  {
    const_cast<LAMMPS_NS::MPMFieldOptions &>(field()->options).locking =
        LAMMPS_NS::MPMFieldOptions::NO_CURE;
  }

  MPM_NS::Grid &grid(const std::string &id = "grid") { return field(id)->grid; }

  /** A node after the step: index, position, velocity, and mass. */
  struct Node {
    int index[3];
    double x[3], v[3], mass;
    bool owned, alias;    ///< this rank counts the node; it is a periodic image of another node
  };
  /** Calls f(node) for all nodes of this rank. */
  template <class F> void each_node(const F &f, const std::string &id = "grid")
  {
    auto &nodes = grid(id);
    for (std::size_t slot = 0; slot < nodes.blocks.size(); slot++)
      for (int n = 0; n < MPM_NS::NODES_PER_BLOCK; n++) {
        const auto &block = nodes.blocks[slot];
        Node node;
        nodes.node_index(block, n, node.index);
        field(id)->lattice.node_position(node.index, node.x);
        const double *record = nodes.record((int) slot, n);
        std::copy(record, record + 3, node.v);
        node.mass = record[3];
        node.owned = block.owned >> n & 1;
        node.alias = block.alias >> n & 1;
        f(node);
      }
  }
  /** Velocity [3] and mass of a node; null if this rank does not have it, or if it has no mass. */
  const double *node(const int index[3], const std::string &id = "grid")
  {
    auto &nodes = grid(id);
    const auto at = nodes.locate(index);
    const double *record = at < 0 ? nullptr : nodes.nodes() + at * nodes.nreal;
    return record && record[3] > 0.0 ? record : nullptr;
  }

  /** Takes the present positions as references; reference(i) gives the one of local atom i. */
  void set_reference()
  {
    auto *atom = lmp->atom;
    references.resize(atom->nlocal + 1);
    for (int i = 0; i < atom->nlocal; i++)
      references[atom->tag[i]] = {atom->x[i][0], atom->x[i][1], atom->x[i][2]};
  }
  const double *reference(int i) const { return references[lmp->atom->tag[i]].data(); }

  /** Adds to L the change of the angular momentum in the last step that is due to moving points
   *  along other velocities than their own, as musl and usavg do: the sum of m (x - reference) x v.
   *  The references must be positions of the step before; they are replaced by the present ones.
   *  sums() without this change conserves what the transfer conserves. */
  void add_angular_momentum_of_motion(double *L)
  {
    for (int i = 0; i < n(); i++) {
      const double *from = reference(i), *u = v()[i];
      for (int d = 0; d < 3; d++) {
        const int e = (d + 1) % 3, f = (d + 2) % 3;
        L[d] += mass()[i] * ((x()[i][e] - from[e]) * u[f] - (x()[i][f] - from[f]) * u[e]);
      }
    }
    set_reference();
  }

  /** Calls f(position, velocity) for all atoms, which may change the velocity. */
  void set_velocity(std::function<void(const double *x, double *v)> f)
  {
    for (int i = 0; i < n(); i++) f(x()[i], v()[i]);
  }

  /** Conserved quantities of all atoms, or of the atoms of one type. The angular momentum L about
   *  the origin includes the spins and the affine matrices of APIC (quadratic and cubic shapes),
   *  which are NaN before the first run. */
  struct Sums {
    double mass, x[3], p[3], L[3], kinetic;    ///< x: center of mass
  };
  Sums sums(int type = 0)
  {
    auto *atom = lmp->atom;
    long double s[11] = {0.0};
    for (int i = 0; i < atom->nlocal; i++) {
      if (type && atom->type[i] != type) continue;
      double r[3];
      lmp->domain->unmap(atom->x[i], atom->image[i], r);
      const double m = atom->rmass[i], *u = atom->v[i];
      s[0] += m;
      for (int d = 0; d < 3; d++) {
        const int e = (d + 1) % 3, f = (d + 2) % 3;
        s[1 + d] += (long double) m * r[d];
        s[4 + d] += (long double) m * u[d];
        s[7 + d] += (long double) m * ((long double) r[e] * u[f] - (long double) r[f] * u[e]);
        s[10] += 0.5L * m * u[d] * u[d];
        if (atom->omega && atom->radius && atom->vfrac[i] == 0.0)
          s[7 + d] += 0.4L * m * atom->radius[i] * atom->radius[i] * atom->omega[i][d];
      }
    }
    for (const auto &id : fields()) {
      const auto *fix = field(id);
      if (!fix->affine || stencil_order(fix->options.shape) == 1) continue;
      const double h = fix->lattice.h;
      const double inertia = h * h / (stencil_order(fix->options.shape) == 2 ? 4.0 : 3.0);
      for (int i = 0; i < atom->nlocal; i++) {
        if (!fix->is_point(i) || (type && atom->type[i] != type)) continue;
        const double *C = fix->affine->C[i];    // C[dim*j+i] = d v_i / d x_j
        const int dim = fix->lattice.dim;
        double CF[9];    // total frame: the velocity C (X - X_p) is at F (X - X_p)
        if (fix->options.total) {
          double F[3][3];
          fix->frame->lattice_F(i, F);
          for (int a = 0; a < dim; a++)
            for (int b = 0; b < dim; b++) {
              CF[dim * b + a] = 0.0;
              for (int k = 0; k < dim; k++) CF[dim * b + a] += C[dim * k + a] * F[b][k];
            }
          C = CF;
        }
        for (int d = dim == 3 ? 0 : 2; d < 3; d++) {
          const int e = (d + 1) % 3, f = (d + 2) % 3;
          s[7 + d] += (long double) atom->rmass[i] * inertia * (C[dim * e + f] - C[dim * f + e]);
        }
      }
    }
    Sums out;
    out.mass = s[0];
    for (int d = 0; d < 3; d++) {
      out.x[d] = s[1 + d] / s[0];
      out.p[d] = s[4 + d];
      out.L[d] = s[7 + d];
    }
    out.kinetic = s[10];
    return out;
  }

  /** Stored energy of the material points. */
  double stored_energy()
  {
    double sum = 0.0;
    visit_point_batches(lmp, 1,
                        [&](const MPM_NS::Batch &b, const int *, const FixMPMMaterial &material) {
                          double w[MPM_NS::BATCH];
                          material.material->stored_energy(b, w);
                          for (int k = 0; k < b.n; k++) sum += b.vol0[k] * w[k];
                        });
    return sum;
  }

 private:
  MPMField *field(const std::string &id = "grid") { return MPMField::find(lmp, id); }
  MPMFrameTotal &total_frame() { return dynamic_cast<MPMFrameTotal &>(*field()->frame); }

  /** An error on one process, that no test expects, ends all: the others would wait for it where
   *  scenes and files are removed. */
  void execute(const std::string &line)
  {
    try {
      lmp->input->one(line);
    } catch (const LAMMPSAbortException &e) {
      if (expected || nranks() == 1) throw;
      fprintf(stderr, "%s\n", e.what());
      fflush(nullptr);
      MPI_Abort(MPI_COMM_WORLD, 1);
    }
  }

  bool expected = false;    // a test asks for the message of an error
  std::vector<double> values;
  std::vector<std::array<double, 3>> references;
  std::function<void(double **)> callback;
};

/** Mass and momentum of points. */
struct Totals {
  double mass = 0.0, p[3] = {0.0, 0.0, 0.0};

  explicit Totals(const std::vector<Scene::State> &points)
  {
    for (const auto &point : points) {
      mass += point.mass;
      for (int d = 0; d < 3; d++) p[d] += point.mass * point.v[d];
    }
  }
};

/** B-spline of order 1 to 3 at the distance u from its node, in spacings, and its slope. */
inline double bspline(int order, double u)
{
  const double a = std::fabs(u);
  if (order == 1) return std::max(1.0 - a, 0.0);
  if (order == 2) return a < 0.5 ? 0.75 - a * a : (a < 1.5 ? 0.5 * (1.5 - a) * (1.5 - a) : 0.0);
  return a < 1.0 ? 2.0 / 3.0 - a * a + 0.5 * a * a * a
                 : (a < 2.0 ? (2.0 - a) * (2.0 - a) * (2.0 - a) / 6.0 : 0.0);
}
inline double bspline_slope(int order, double u)
{
  const double a = std::fabs(u), sign = u < 0.0 ? -1.0 : 1.0;
  if (order == 1) return a < 1.0 ? -sign : 0.0;
  if (order == 2) return a < 0.5 ? -2.0 * u : (a < 1.5 ? -sign * (1.5 - a) : 0.0);
  return sign * (a < 1.0 ? -2.0 * a + 1.5 * a * a : (a < 2.0 ? -0.5 * (2.0 - a) * (2.0 - a) : 0.0));
}

/** Makes largest at least as large as the magnitude of a value; not a number is infinite, while
 *  std::max passes over it. */
inline void grow(double &largest, double value)
{
  largest = std::max(largest, std::isnan(value) ? INFINITY : std::fabs(value));
}

/** Shows a measured number in the output of the test, and returns it. */
inline double measured(const std::string &what, double value)
{
  printf("[ MEASURED ] %s: %.6g\n", what.c_str(), value);
  fflush(stdout);
  return value;
}

inline double sum_over_ranks(double x)
{
  double all;
  MPI_Allreduce(&x, &all, 1, MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
  return all;
}

/** Largest difference between two sets of states. Each quantity is relative to its largest
 *  magnitude; the stress is relative to the given one if that is larger. It is 1e300 if there are
 *  no points, not the same number of them, or NaN. */
inline double difference(const std::vector<Scene::State> &a, const std::vector<Scene::State> &b,
                         double stress = 1.0e-300)
{
  if (a.size() != b.size() || a.empty()) return 1.0e300;
  const int reals = sizeof(Scene::State) / sizeof(double);
  const int first[] = {0, 1, 2, 5, 8, 17, 23, 24}, last[] = {1, 2, 5, 8, 17, 23, 24, reals};
  double worst = 0.0;
  for (int g = 0; g < 8; g++) {
    double scale = g == 5 ? stress : 1.0e-300, diff = 0.0;
    for (std::size_t k = 0; k < a.size(); k++) {
      const double *p = &a[k].tag, *q = &b[k].tag;
      for (int r = first[g]; r < last[g]; r++) {
        scale = std::max(scale, std::max(std::abs(p[r]), std::abs(q[r])));
        diff = std::max(diff, std::abs(p[r] - q[r]));
        if (!(p[r] == p[r]) || !(q[r] == q[r])) return 1.0e300;
      }
    }
    worst = std::max(worst, diff / scale);
  }
  return worst;
}

/** Whether two sets of states are equal to the last bit. */
inline bool identical(const std::vector<Scene::State> &a, const std::vector<Scene::State> &b)
{
  return a.size() == b.size() && !memcmp(a.data(), b.data(), a.size() * sizeof(Scene::State));
}

/** A scene on one rank, and the same on all ranks. layout: commands for the latter only. */
struct OnRanks {
  Scene serial{MPI_COMM_SELF}, parallel;

  OnRanks(const std::string &scene, const std::string &run, const std::string &layout = "")
  {
    serial.commands(scene + run);
    // the command processors must come before the box is created
    if (layout.find("processors") == 0)
      parallel.commands(layout + scene + run);
    else
      parallel.commands(scene + layout + run);
  }
  double difference() { return MPM_TEST::difference(serial.gather(), parallel.gather()); }
};

/** A scene that writes a restart file in the middle, and one that continues from this file. */
struct Continued {
  Scene whole, again;

  /** Runs the scene for before steps, writes a restart file, and runs for after steps. again: reads
   *  the restart file, executes next, and runs for after steps. */
  Continued(const std::string &scene, int before, const std::string &next, int after)
  {
    const ScratchFile file("restart");
    const std::string last = "run " + std::to_string(after) + "\n";
    whole.commands(scene + "run " + std::to_string(before) + "\nwrite_restart " + file.name + "\n" +
                   last);
    again.commands("read_restart " + file.name + "\n" + next + last);
  }
};

/** Two soft bodies that cross all rank boundaries of a periodic box, collide, and deform. */
inline const std::string two_bodies = space("lj", "p p p", "0 8 0 8 0 8", 2) + R"(
fix grid all mpm 1.0 MPM_OPTIONS
)" + bodies({{"one", "sphere 2.6 3.0 3.2 1.9"}, {"two", "block 4.8 7.3 2.0 5.0 2.5 5.5"}}) +
    R"(
fix m1 one mpm/material density 1.0 neohookean 10.0 0.3
fix m2 two mpm/material density 2.0 linear 20.0 0.2
velocity one set 0.6 0.35 -0.4
velocity two set -0.5 0.1 0.3
timestep 0.05
)";

/** A scene on one rank, on all ranks, and continued from a restart file in the middle. Expects the
 *  first two to differ by less than the tolerance, and the last two to be equal to the last bit. */
struct Twins {
  Scene serial{MPI_COMM_SELF}, whole, again;

  /** Runs the scene for before steps, writes a restart file, and runs for after steps. again: reads
   *  the restart file, executes next, and runs for after steps. */
  Twins(const std::string &scene, int before, const std::string &next, int after, double tolerance)
  {
    const ScratchFile file("restart");
    const std::string first = scene + "run " + std::to_string(before) + "\n";
    const std::string last = "run " + std::to_string(after) + "\n";
    serial.commands(first + last);
    whole.commands(first + "write_restart " + file.name + "\n" + last);
    again.commands("read_restart " + file.name + "\n" + next + last);
    EXPECT_LT(measured("difference to one rank", difference(serial.gather(), whole.gather())),
              tolerance);
    EXPECT_TRUE(identical(whole.gather(), again.gather()));
  }
};

/** The log of these commands. */
inline std::string log_of(Scene &run, const std::string &commands)
{
  const ScratchFile log("said.log");
  run.commands("log " + log.name + "\n" + commands + "log none\n");
  MPI_Barrier(MPI_COMM_WORLD);    // the first rank writes the file
  return file_text(log.name);
}

/** Lines of the log of these commands that contain these words. */
inline std::vector<std::string> lines_that_say(const std::string &commands,
                                               const std::string &words)
{
  Scene run;
  std::istringstream log(log_of(run, commands));
  std::vector<std::string> lines;
  for (std::string line; std::getline(log, line);)
    if (line.find(words) != std::string::npos) lines.push_back(line);
  return lines;
}

/** How many lines of the log of these commands contain these words. */
inline int times_said(const std::string &commands, const std::string &words)
{
  return (int) lines_that_say(commands, words).size();
}

/** The message of the error that an input gives; empty: no error. */
inline std::string error_of(const std::string &input)
{
  Scene scene;
  return scene.error(input);
}

/** Expects lines of input to give an error whose message contains these words. */
inline void expect_error(Scene &scene, const std::string &lines, const std::string &words)
{
  const auto found = scene.error(lines);
  EXPECT_THAT(found, HasSubstr(words)) << lines;
  EXPECT_NE(found, "") << lines;
}
inline void expect_error(const std::string &input, const std::string &words)
{
  Scene scene;
  expect_error(scene, input, words);
}

/** A mistake in the input, and words of the error message that it must give. */
struct Mistake {
  std::string lines, message;
};

/** Expects each of these mistakes to be refused after a valid scene, each in an instance of its
 *  own. run: further lines of input. */
inline void expect_refused(const std::string &scene, const std::vector<Mistake> &mistakes,
                           const std::string &run = "")
{
  for (const auto &mistake : mistakes) {
    Scene instance(scene);
    expect_error(instance, mistake.lines + "\n" + run, mistake.message);
  }
}

/** Expects each of these options of fix mpm to be refused in the scene two_bodies. */
inline void expect_options_refused(const std::vector<Mistake> &mistakes)
{
  for (const auto &mistake : mistakes)
    expect_error(replaced(two_bodies, "MPM_OPTIONS", mistake.lines) + "run 1\n", mistake.message);
}

}    // namespace MPM_TEST
#endif
