// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public License,
// version 2; see the file LICENSE.

#ifndef MPM_LAMMPS_TEST_H
#define MPM_LAMMPS_TEST_H

// A LAMMPS instance for tests, on any communicator: one rank may run its own serial reference
// next to a parallel run. This header brings what nearly all tests need, so that they need not name it.

#include "atom.h"
#include "comm.h"
#include "compute.h"
#include "domain.h"
#include "fix.h"
#include "fix_external.h"
#include "fix_mpm.h"
#include "fix_mpm_material.h"
#include "force.h"
#include "input.h"
#include "lammps.h"
#include "material/batch.h"
#include "material/material.h"
#include "modify.h"
#include "mpm_affine.h"
#include "mpm_cpdi.h"
#include "mpm_every.h"
#include "mpm_field.h"
#include "mpm_frame_total.h"
#include "mpm_locking.h"
#include "mpm_node_sums.h"
#include "mpm_point_batches.h"
#include "mpm_points.h"
#include "mpm_time_limit.h"
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
#include <stdexcept>
#include <string>
#include <vector>

namespace MPM_TEST {

using namespace LAMMPS_NS;
using ::testing::HasSubstr;
using ::testing::Values;
using ::testing::ValuesIn;

constexpr double PI = 3.14159265358979323846;

/** A test of what does not depend on the number of ranks: on more than one it is skipped. */
#define SERIAL_TEST(suite, name)                            \
  static void suite##_##name();                             \
  TEST(suite, name)                                         \
  {                                                         \
    if (nranks() > 1) GTEST_SKIP() << "one rank is enough"; \
    suite##_##name();                                       \
  }                                                         \
  static void suite##_##name()

/** A test for each of some parameters: Values(...) or ValuesIn(...). */
#define PARAMETER_TEST(suite, name, type, ...)            \
  class suite : public ::testing::TestWithParam<type> {}; \
  INSTANTIATE_TEST_SUITE_P(All, suite, __VA_ARGS__);      \
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

/** Sums over all ranks, or what else these are to be reduced to. */
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

/** The rows of all ranks, one rank after the other. */
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

/** The same in order of their tags. */
template <class T> std::vector<T> all_by_tag(const std::vector<T> &mine, MPI_Comm comm)
{
  auto all = all_rows(mine, comm);
  std::sort(all.begin(), all.end(), [](const T &a, const T &b) {
    return a.tag < b.tag;
  });
  return all;
}

/** A file that exists during a test at the most; all ranks wait when it is made and removed. Its
 *  name has the source of the test and the number of ranks in front, since tests may run at the
 *  same time. */
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
    const auto start = file.rfind('/') + 1;    // 0 where there is none
    return file.substr(start, file.rfind('.') - start);
  }
};

/** What a file has in it, nothing if there is none. */
inline std::string file_text(const std::string &name)
{
  std::ifstream file(name, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/** Text with the arguments of printf in it. */
template <class... Args> std::string strprintf(const char *text, Args... args)
{
  std::vector<char> buffer(snprintf(nullptr, 0, text, args...) + 1);
  snprintf(buffer.data(), buffer.size(), text, args...);
  return buffer.data();
}

/** Scene with its words in capitals, MPM_<name>, replaced. */
inline std::string replaced(std::string scene, const std::string &word, const std::string &text)
{
  for (std::size_t at = 0; (at = scene.find(word, at)) != std::string::npos; at += text.size())
    scene.replace(at, word.size(), text);
  return scene;
}

/** The first lines of a scene: a box, and material points as atoms. faces: "f f f", extent: "xlo xhi ylo yhi zlo zhi";
 *  in 2d without those of z, which are periodic, -0.5 and 0.5. skin: of neighbor lists, 0: LAMMPS's default. */
inline std::string space(const std::string &units, const std::string &faces,
                         const std::string &extent, int types = 1, double skin = 0.0, int dim = 3)
{
  return strprintf("units %s\ndimension %d\nboundary %s\natom_style mpm\n", units.c_str(), dim,
                   faces.c_str()) +
      (skin > 0.0 ? strprintf("neighbor %.17g bin\n", skin) : "") +
      strprintf("region box block %s\ncreate_box %d box\n", extent.c_str(), types);
}

/** faces: "f f"; the extent may have that along z, for another thickness. */
inline std::string plane(const std::string &units, const std::string &faces, std::string extent,
                         int types = 1, double skin = 0.0)
{
  if (std::count(extent.begin(), extent.end(), ' ') == 3) extent += " -0.5 0.5";
  return space(units, faces + " p", extent, types, skin, 2);
}

/** In 2d, of faces and extent what is in the plane. */
inline std::string box(int dim, const std::string &units, const std::string &faces,
                       std::string extent, int types = 1, double skin = 0.0)
{
  if (dim == 3) return space(units, faces, extent, types, skin);
  std::size_t end = 0;
  for (int word = 0; word < 4; word++) end = extent.find(' ', end + 1);
  return plane(units, faces.substr(0, 3), extent.substr(0, end), types, skin);
}

/** Next, mostly: a lattice, and one body of one material (region "box": that fills the box). grid: node spacing
 *  and options. The fixes are named grid and m, the region body. */
inline std::string body(const std::string &region, const std::string &material,
                        const std::string &grid = "1.0", const std::string &ppc = "2")
{
  const bool fills = region == "box";
  return "fix grid all mpm " + grid + "\n" + (fills ? "" : "region body " + region + "\n") +
      "create_points 1 " + (fills ? "box" : "region body") + " ppc " + ppc + "\n" +
      "fix m all mpm/material " + material + "\n";
}

/** A body of points: region and group have its name. lattice: spacing and options of its fix mpm. */
struct Body {
  std::string name, region, lattice = "";
};

/** Bodies of types 1, 2, ...; sites: options of create_points, in which # is the type. */
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

/** Bodies of types 1, 2, ..., each in a field of its own, which are fixes F1, F2, ...; lattice: of those that
 *  have none. */
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

/** A LAMMPS instance: what a test drives. (Not named Run, which is a member of ::testing::Test.) */
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

  /** Execute lines of input; & at the end of a line continues it as in a script. */
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
      if (!line.empty()) lmp->input->one(line);
      line.clear();
    }
  }

  /** The message of the error that lines of input give on all ranks, or nothing. */
  std::string error(const std::string &text)
  {
    try {
      commands(text);
    } catch (const std::exception &e) {
      return e.what();
    }
    return "";
  }

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
  /** Evaluate an equal-style formula, in a run 0 so that computes are current. */
  double evaluate(const std::string &formula)
  {
    return lmp->input->variable->compute_equal(formula);
  }

  /** Values of a compute, by default of a compute e all mpm/energy. */
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

  /** State of one point, gathered on all ranks, in order of tags. */
  struct State {
    double tag, type, x[3], v[3], F[9], stress[6], vol, mass;
    double pressure() const { return -(stress[0] + stress[1] + stress[2]) / 3.0; }
  };
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

  // what follows is for one rank

  /** Call f after the forces of each step, also of step 0: positions, velocities and stress are of
   *  that time, and what f writes to force[i], which is zero before, acts in the step that follows.
   *  every: only at multiples of this number (for output, not for forces).
   *  To be called once, when the box exists. */
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
  template <class T = Fix> T *fix(const std::string &id)
  {
    return dynamic_cast<T *>(lmp->modify->get_fix_by_id(id));
  }
  FixMPMMaterial *material(const std::string &id = "m") { return fix<FixMPMMaterial>(id); }

  // what tests read of a field: nothing else in the tests knows the members of fix mpm
  std::vector<std::string> fields()
  {
    std::vector<std::string> ids;
    for (auto *one : lmp->modify->get_fix_by_style("^mpm$")) ids.push_back(one->id);
    return ids;
  }
  int dim() { return lmp->domain->dimension; }
  double spacing(const std::string &id = "grid") { return field(id)->lattice.h; }
  bool is_point(int i, const std::string &id = "grid") { return field(id)->is_point(i); }
  /** C[dim*j+i] = d v_i / d x_j of APIC, for each point; null without. */
  MPMRows affine(const std::string &id = "grid")
  {
    return field(id)->affine ? field(id)->affine->C : MPMRows();
  }
  /** Bilinear modes of PolyPIC; null without. */
  MPMRows modes(const std::string &id = "grid")
  {
    return field(id)->affine ? field(id)->affine->Q : MPMRows();
  }
  /** Corners of CPDI2 from the point; null without. */
  MPMRows corners(const std::string &id = "grid")
  {
    return field(id)->domains ? field(id)->domains->corners : MPMRows();
  }
  /** Reference positions, and F at the last update of the reference (total frame). */
  MPMRows reference_positions() { return total_frame().X; }
  MPMRows reference_F() { return total_frame().R; }
  /** Displacement since the last step of the cycle. */
  double waiting(int i, int d, const std::string &id = "grid")
  {
    return field(id)->every ? field(id)->every->displacement(i, d) : 0.0;
  }
  /** This rank's stable time step; the point that has it, and its wave speed. */
  double stable_dt(tagint *tag = nullptr, double *wave_speed = nullptr)
  {
    tagint whose;
    double c;
    return field()->time_limit->stable_dt(tag ? *tag : whose, wave_speed ? *wave_speed : c);
  }
  /** The share that points have of the volume around them. */
  std::vector<double> volume_shares()
  {
    std::vector<double> share;
    volume_at_points(*field(), share);
    return share;
  }
  /** Work of the walls on this rank. */
  double work_of_boundaries() { return field()->ledger.boundary; }
  /** From the next run on. Another fix mpm would lose its reference configuration. */
  void switch_locking_off()
  {
    const_cast<LAMMPS_NS::MPMFieldOptions &>(field()->options).locking =
        LAMMPS_NS::MPMFieldOptions::NO_CURE;
  }

  MPM_NS::Grid &grid(const std::string &id = "grid") { return field(id)->grid; }

  /** A node after the step. */
  struct Node {
    int index[3];
    double x[3], v[3], mass;
    bool owned, alias;    ///< counted by this rank; periodic image of another one
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
  /** Velocity and mass of a node of this rank; null where there is none, or no mass. */
  const double *node(const int index[3], const std::string &id = "grid")
  {
    auto &nodes = grid(id);
    const auto at = nodes.locate(index);
    const double *record = at < 0 ? nullptr : nodes.nodes() + at * nodes.nreal;
    return record && record[3] > 0.0 ? record : nullptr;
  }

  /** Take the present positions as the reference: reference(i) is then that of local atom i. */
  void set_reference()
  {
    auto *atom = lmp->atom;
    references.resize(atom->nlocal + 1);
    for (int i = 0; i < atom->nlocal; i++)
      references[atom->tag[i]] = {atom->x[i][0], atom->x[i][1], atom->x[i][2]};
  }
  const double *reference(int i) const { return references[lmp->atom->tag[i]].data(); }

  /** Adds to L what the last step changed of the angular momentum by moving points along other velocities than those
   *  that they have, as musl and usavg do: sum of m (x - reference) x v. References are to be of the step before, and
   *  are of this one then. The sums without it keep what the transfer keeps. */
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

  /** Set the velocity of all atoms to f(position, velocity). */
  void set_velocity(std::function<void(const double *x, double *v)> f)
  {
    for (int i = 0; i < n(); i++) f(x()[i], v()[i]);
  }

  /** Conserved quantities of all atoms, or of those of one type. The angular momentum about the
   *  origin has the part of spins, and that of the affine matrices of APIC (quadratic and cubic),
   *  which are not numbers before the first run. */
  struct Sums {
    double mass, x[3], p[3], L[3], kinetic;    ///< x: centre of mass
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

  /** Energy that the material points store. */
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

/** B-splines of order 1 to 3 at a distance from their node, in spacings, and their slopes. */
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

/** Show a measured number in the output of the test. */
inline double measured(const std::string &what, double value)
{
  printf("[ MEASURED ] %s: %.6g\n", what.c_str(), value);
  fflush(stdout);
  return value;
}

/** Largest difference of two sets of states, each quantity relative to its largest magnitude, stress to
 *  the given one if that is larger. */
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

/** The same to the last bit. */
inline bool identical(const std::vector<Scene::State> &a, const std::vector<Scene::State> &b)
{
  return a.size() == b.size() && !memcmp(a.data(), b.data(), a.size() * sizeof(Scene::State));
}

/** A scene on one rank, and the same on all of them, there with a layout of the ranks. */
struct OnRanks {
  Scene serial{MPI_COMM_SELF}, parallel;

  OnRanks(const std::string &scene, const std::string &run, const std::string &layout = "")
  {
    serial.commands(scene + run);
    // the number of ranks along axes must be given before there is a box
    if (layout.find("processors") == 0)
      parallel.commands(layout + scene + run);
    else
      parallel.commands(scene + layout + run);
  }
  double difference() { return MPM_TEST::difference(serial.gather(), parallel.gather()); }
};

/** A scene that writes a restart file on its way, and one that goes on from this file. */
struct Continued {
  Scene whole, again;

  /** scene ... run before, write_restart, run after; and read_restart, next ..., run after */
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

/** The same on one rank and on all, and to the last bit after a restart file in the middle of the run. */
struct Twins {
  Scene serial{MPI_COMM_SELF}, whole, again;

  /** scene ... run before, write_restart, run after; and read_restart, next ..., run after */
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

/** Lines of the log of these commands that have these words. */
inline std::vector<std::string> lines_that_say(const std::string &commands,
                                               const std::string &words)
{
  Scene run;
  const ScratchFile log("said.log");
  run.commands("log " + log.name + "\n" + commands + "log none\n");
  MPI_Barrier(MPI_COMM_WORLD);
  std::vector<std::string> lines;
  std::ifstream file(log.name);
  for (std::string line; std::getline(file, line);)
    if (line.find(words) != std::string::npos) lines.push_back(line);
  return lines;
}

/** The message of the error that an input gives, or nothing. */
inline std::string error_of(const std::string &input)
{
  Scene scene;
  return scene.error(input);
}

/** Lines of input give an error with these words. */
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

/** Mistakes in the input, each with words of its message. */
struct Mistake {
  std::string lines, message;
};

/** Each of these lines is refused after a scene that is fine, each in an instance of its own. */
inline void expect_refused(const std::string &scene, const std::vector<Mistake> &mistakes,
                           const std::string &run = "")
{
  for (const auto &mistake : mistakes) {
    Scene instance(scene);
    expect_error(instance, mistake.lines + "\n" + run, mistake.message);
  }
}

/** Options of fix mpm that are refused for two bodies. */
inline void expect_options_refused(const std::vector<Mistake> &mistakes)
{
  for (const auto &mistake : mistakes)
    expect_error(replaced(two_bodies, "MPM_OPTIONS", mistake.lines) + "run 1\n", mistake.message);
}

}    // namespace MPM_TEST
#endif
