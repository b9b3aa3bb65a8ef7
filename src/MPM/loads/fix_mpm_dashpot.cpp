/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/* ----------------------------------------------------------------------
   Behind its surface a body goes on for ever. A plane wave that arrives along the normal n takes
   the traction

     t = -Z (v - 2 v_in) + t_0,   Z = rho c_p n n + rho c_s (1 - n n)

   with it, where v_in is the velocity of a wave that comes from the far side, and t_0 what the far
   side bears at rest (J. Lysmer, R.L. Kuhlemeyer, J. Eng. Mech. Div. ASCE 95 (1969) 859; the
   incoming wave: W.B. Joyner, A.T.F. Chen, Bull. Seismol. Soc. Am. 65 (1975) 1315).

   Marks. The velocity must be that on the surface: a dashpot half a spacing of points below it
   reflects k s/4 of a wave of the wave number k. Each point of the first two layers, with shares of
   the area hat(depth - 1) that sum to one wherever the layers are, has a mark at its foot on the
   surface. The mark sees v = sum_i w_i v_i of the nodes around it, and its impulse P goes to these
   with the same w_i, so that the dashpots only take energy. The weights are the functions of the
   lattice there, less at nodes on which dashpots would act faster than FASTEST, which points hardly
   reach; the others have so much more that the sum of w_i is one and that of w_i x_i stays at the
   mark.

   Time. With a = dt w M^-1 w A Z a dashpot alone on its nodes obeys du/ds = -a (u - b) + D within a
   step, s from 0 to 1, from the old velocity u_0 at the mark on. D is what forces change in the
   step, and b = 2 v_in. Its mean over the step, phi u_0 + (1 - phi)/a D + (1 - phi) b with phi = (1
   - exp(-a))/a, times A dt Z is what the dashpot takes. This is of second order in the time step,
   has the right state at rest, and damps for any step. Marks share nodes: a is that of a wave which
   all of them see, by the sums of A Z at the nodes; no wave has a larger one.

   The static support is a dead load with the stress at the start, which is put on the layers of
   points as that of fix mpm/traction. What nodes next to the surface lack in the first step so as
   not to be accelerated is a part of the support, too, at the marks: otherwise it would move the
   body with a constant velocity.

   A free field. Where the far side is level ground that is shaken, too, it is a column (fix
   mpm/column), and v is the velocity relative to it, at the same height, and t_0 changes by what
   the traction of its stress has changed since the start.
------------------------------------------------------------------------- */

#include "loads/fix_mpm_dashpot.h"

#include "base/mpm_options.h"
#include "base/mpm_points.h"
#include "field/mpm_block_passes.h"
#include "field/mpm_field.h"
#include "field/mpm_frame.h"
#include "loads/fix_mpm_column.h"
#include "loads/mpm_face.h"
#include "math/matrix.h"

#include "atom.h"
#include "comm.h"
#include "domain.h"
#include "error.h"
#include "force.h"
#include "math_extra.h"
#include "modify.h"

#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;
using namespace MPM_NS;
using Data = MPMStageData;    // what stages read and write

// rate of a node, in wave speeds over node spacings, times the density of the far side over that of
// the body: with stress mls, stress pulls less at nodes that points hardly reach than the functions
// there tell, and dashpots must not pull more
static constexpr double FASTEST = 20.0, FASTEST_MLS = 6.0;

// of a symmetric tensor, xx yy zz xy xz yz
static constexpr int ROW[6] = {0, 1, 2, 0, 0, 1}, COLUMN[6] = {0, 1, 2, 1, 2, 2};

// cells below the surface whose nodes count for what the support lacks
static constexpr int DEPTH = 3;

static constexpr double UPRIGHT = 1.0e-3;    // slope of a surface at the side of a column

FixMPMDashpot::FixMPMDashpot(LAMMPS *lmp, int narg, char **arg) : FixMPMState(lmp, narg, arg)
{
  Options options = declare(domain->dimension);
  read_options(lmp, options, narg, arg, 3);
  scalar_flag = vector_flag = 1;
  size_vector = 7;
  global_freq = 1;
  extscalar = extvector = 1;
  restart_global = 1;
  dynamic_group_allow = 0;
  state.declare(rows, "mark", column.empty() ? WIDTH : WIDTH_COLUMN);
  keep_arrays();
}

void FixMPMDashpot::init()
{
  require_field(lmp, *this);
  for (auto &v : incoming) find_variable(lmp, v, "fix mpm/dashpot " + std::string(id));
  if (!defined && !domain->get_region_by_id(region))
    error->all(FLERR, Error::NOLASTLINE, "Region {} for fix mpm/dashpot {} does not exist", region,
               id);
  static const char *const WATER[] = {"pore", "mixture", "incompressible"};
  for (const char *style : WATER)
    if (!modify->get_fix_by_style(std::string("^mpm/") + style + "$").empty())
      error->all(FLERR, Error::NOLASTLINE,
                 "Fix mpm/dashpot {} takes waves of one material, and there is a fix mpm/{}: use "
                 "faces further away, or soil without water",
                 id, style);
}

/** Its layers and rows must be those of the same step: it comes first. */
void FixMPMDashpot::find_column()
{
  free_field = nullptr;
  for (auto *ifix : modify->get_fix_list()) {
    if (ifix == this) break;
    if (column == ifix->id) free_field = dynamic_cast<FixMPMColumn *>(ifix);
  }
  if (!free_field)
    error->all(
        FLERR, Error::NOLASTLINE,
        "Fix mpm/dashpot {}: there is no fix mpm/column with the ID {} before it: define it first",
        id, column);
}

/** The nodes are those of this run. */
void FixMPMDashpot::init_physics(MPMPlan &plan)
{
  bodies.clear();
  if (!column.empty()) find_column();
  for (auto *field : plan.fields) {
    const auto &options = field->options;
    if (free_field)
      refuse_field(
          lmp, *this, *field,
          {{options.total != free_field->ground().options.total, "this frame",
            "points and column are not at the same height for long: use the same frame for both"}});
    refuse_field(lmp, *this, *field,
                 {{options.modified_edges, "edges modified", "use edges plain, the default"},
                  {options.has_fmpm(), "transfer fmpm",
                   "its terms do not have the dashpots: use another transfer"}});
    warn_of_light_nodes(*field);
    field->keep_old_velocities();
    bodies.emplace_back();
    bodies.back().field = field;
    bodies.back().rates = &field->nodes.add_field("rates of " + std::string(id), 6);
    bodies.back().pushes = &field->nodes.add_field("pushes of " + std::string(id), 3);
  }
}

/** With the velocities of points that are mapped back, or stress that is older, dashpots at nodes
 *  that points hardly reach take more than the wave brings: a surface on a plane of nodes takes 5
 *  to 20 % of its amplitude, and more of it on finer lattices. */
void FixMPMDashpot::warn_of_light_nodes(const MPMField &field) const
{
  const auto &o = field.options;
  if (o.scheme == MPMFieldOptions::USL || !is_mls(o.shape, o.transfer) || o.strains_by_gradient() ||
      comm->me)
    return;
  error->warning(
      FLERR,
      "Fix mpm/dashpot {}: with this scheme and stress mls of fix mpm {}, a surface "
      "next to a plane of nodes takes up to 20 % of the amplitude of waves: use scheme usl, {}",
      id, field.id(), o.total ? "the default" : "or stress gradient");
}

FixMPMDashpot::Body &FixMPMDashpot::body_of(const MPMField &field)
{
  return *std::find_if(bodies.begin(), bodies.end(), [&](const Body &body) {
    return body.field == &field;
  });
}

/** What this run starts with: the surface, where points are now, and the stress that it bears. */
void FixMPMDashpot::setup(int vflag)
{
  if (!defined) define();
  post_run();
  post_force(vflag);
}

/** Have points of the surface been deleted? */
void FixMPMDashpot::post_run()
{
  int here = 0;
  for (int i = 0; i < atom->nlocal; i++) here += rows[i][SHARE] != 0.0 || rows[i][AREA] != 0.0;
  MPMFace::note_lost(lmp, "Fix mpm/dashpot " + std::string(id), here, known);
}

/** Of the stress sigma, xx yy zz xy xz yz, on a surface with the normal n. */
static void traction(const double *sigma, const double *n, double t[3])
{
  t[0] = sigma[0] * n[0] + sigma[3] * n[1] + sigma[4] * n[2];
  t[1] = sigma[3] * n[0] + sigma[1] * n[1] + sigma[5] * n[2];
  t[2] = sigma[4] * n[0] + sigma[5] * n[1] + sigma[2] * n[2];
}

void FixMPMDashpot::define()
{
  const auto *const points = MPMPoints::get(atom);
  double mine[2] = {0.0, 0.0}, all[2];    // area, points with a share
  double most = 0.0, most_of_all;         // stress that is held
  double ends[3] = {1.0e300, 1.0e300, 0.0},
         all_ends[3];    // lowest point; minus the highest one, and the steepest normal
  MPMFace face(lmp, domain->get_region_by_id(region), spacing);
  for (const auto &body : bodies) {
    if (free_field && body.field == &free_field->ground()) continue;
    face.find(*body.field, groupbit, [&](int i, const MPMFace::Share &share) {
      double *const row = rows[i], sigma[6], held[3];
      const double *const n = share.normal;
      points->cauchy(i, sigma);
      traction(sigma, n, held);
      row[AREA] = share.covered;
      row[SHARE] = share.area;
      row[STRESS] = share.stress;
      row[DENSITY] = density > 0.0 ? density
                                   : atom->rmass[i] / (atom->vfrac[i] * points->jacobian(i));
      for (int d = 0; d < 3; d++) {
        row[NORMAL + d] = n[d];
        row[WAY + d] = share.depth * n[d];
        row[HELD + d] = support && d < domain->dimension ? held[d] / force->nktv2p : 0.0;
        row[MOTION + d] = row[LACK + d] = 0.0;
        most = std::max(most, std::fabs(row[HELD + d]));
      }
      mine[0] += share.covered;
      mine[1] += 1.0;
      if (!free_field) return;
      const double at = body.field->frame->places()[i][free_field->axis];
      ends[0] = std::min(ends[0], at);
      ends[1] = std::min(ends[1], -at);
      ends[2] = std::min(ends[2], -std::fabs(n[free_field->axis]));
      double free[3];
      column_traction(i, free);
      for (int d = 0; d < 3; d++) row[REST + d] = support ? row[HELD + d] - free[d] : 0.0;
    });
  }
  MPI_Allreduce(mine, all, 2, MPI_DOUBLE, MPI_SUM, world);
  MPI_Allreduce(&most, &most_of_all, 1, MPI_DOUBLE, MPI_MAX, world);
  if (free_field) {
    MPI_Allreduce(ends, all_ends, 3, MPI_DOUBLE, MPI_MIN, world);
    if (all[1] > 0.0) check_column(all_ends[0], -all_ends[1], -all_ends[2]);
  }
  face.check("Fix mpm/dashpot " + std::string(id), igroup, area);
  const double scale = area > 0.0 ? area / all[0] : 1.0;
  for (int i = 0; i < atom->nlocal; i++)
    for (const int k : {(int) AREA, (int) SHARE, (int) STRESS}) rows[i][k] *= scale;
  fresh = most_of_all > 0.0;
  supports = fresh || free_field;
  defined = true;
  warn_about_others();
  for (auto &body : bodies) body.field->map->valid = false;    // marks may need other blocks
  if (comm->me == 0)
    utils::logmesg(lmp, "Fix mpm/dashpot {}: area {:.8g} of {:.0f} points\n", id, all[0] * scale,
                   all[1]);
}

/** The same face of a point under two of these would have twice the resistance, which sends waves
 *  back: (1 - 2)/(1 + 2) of them. */
void FixMPMDashpot::warn_about_others() const
{
  constexpr double SAME_SIDE = 0.9, MUCH = 0.05;    // cosine of normals; of the smaller area
  for (auto *ifix : modify->get_fix_by_style("^mpm/dashpot$")) {
    const auto *const other = dynamic_cast<FixMPMDashpot *>(ifix);
    if (other == this || !other->defined) continue;
    double mine[3] = {0.0, 0.0, 0.0}, all[3];    // areas of this and the other one, and of both
    for (int i = 0; i < atom->nlocal; i++) {
      const double *const a = rows[i], *const b = other->rows[i];
      mine[0] += a[AREA];
      mine[1] += b[AREA];
      if (a[AREA] > 0.0 && b[AREA] > 0.0 && dot(a + NORMAL, b + NORMAL) > SAME_SIDE)
        mine[2] += std::min(a[AREA], b[AREA]);
    }
    MPI_Allreduce(mine, all, 3, MPI_DOUBLE, MPI_SUM, world);
    if (comm->me == 0 && all[2] > MUCH * std::min(all[0], all[1]))
      error->warning(FLERR,
                     "Fix mpm/dashpot {}: {:.3g} % of its area has the dashpots of fix {}, too, "
                     "which add up there, so that waves are reflected: give the two different "
                     "regions or groups",
                     id, 100.0 * all[2] / all[0], other->id);
  }
}

// The column at the far side.

/** lowest, highest: points of the surface; steepest: largest cosine between its normal and the
 *  column. */
void FixMPMDashpot::check_column(double lowest, double highest, double steepest) const
{
  if (steepest > UPRIGHT)
    error->all(
        FLERR, Error::NOLASTLINE,
        "Fix mpm/dashpot {}: the surface of region {} is not parallel to the column {}, which "
        "stands along {}",
        id, region, column, "xyz"[free_field->axis]);
  const double margin = free_field->apart();
  if (lowest < free_field->lowest() - margin || highest > free_field->highest() + margin)
    error->all(
        FLERR, Error::NOLASTLINE,
        "Fix mpm/dashpot {}: points at the surface of region {} are between {:.6g} and {:.6g}, "
        "but the column {} only between {:.6g} and {:.6g}: ground next to the surface must be "
        "level, and as high as the column",
        id, region, lowest, highest, column, free_field->lowest(), free_field->highest());
}

/** Of its stress, on the surface of the body at point i [force/area]. */
void FixMPMDashpot::column_traction(int i, double t[3]) const
{
  const double *const n = rows[i] + NORMAL;
  const auto *const field = std::find_if(bodies.begin(), bodies.end(), [i](const Body &body) {
                              return body.field->is_point(i);
                            })->field;
  double s[6];
  free_field->stress(field->frame->places()[i][free_field->axis], s);
  traction(s, n, t);
  for (int d = 0; d < 3; d++) t[d] = d < domain->dimension ? t[d] / force->nktv2p : 0.0;
}

/** Blocks around marks: points of other ranks may be the only ones that reach these. */
template <class F> void FixMPMDashpot::visit_marks(const Body &body, const F &f) const
{
  const auto places = body.field->frame->places();
  for (const int i : body.points) {
    const double *const row = rows[i];
    double x[3];
    for (int d = 0; d < 3; d++) x[d] = places[i][d] + row[WAY + d];
    f(i, x);
  }
}

void FixMPMDashpot::extend_topology(MPMField &field)
{
  Body &body = body_of(field);
  Grid &grid = field.grid;
  body.points.clear();
  for (int i = 0; i < atom->nlocal; i++)
    if (rows[i][AREA] > 0.0 && field.is_point(i)) body.points.push_back(i);
  body.blocks.clear();
  // points may move by a cell before blocks are renewed
  visit_marks(body, [&](int, const double *x) {
    blocks_around(field, x, 0.0, fresh ? 1 + DEPTH : 1, [&](const int *b) {
      body.blocks.push_back(Grid::block_key(grid.blocks[grid.activate(b)]));
    });
  });
  std::sort(body.blocks.begin(), body.blocks.end());
  body.blocks.erase(std::unique(body.blocks.begin(), body.blocks.end()), body.blocks.end());
}

bool FixMPMDashpot::looks_at_all(const MPMField &field, const Grid::Block &block) const
{
  return std::any_of(bodies.begin(), bodies.end(), [&](const Body &body) {
    return body.field == &field &&
        std::binary_search(body.blocks.begin(), body.blocks.end(), Grid::block_key(block));
  });
}

void FixMPMDashpot::topology_changed(MPMField &field)
{
  Body &body = body_of(field);
  body.canonical = field.grid.canonical();
  body.stressed.clear();
  if (!supports) return;
  each_point(field, [&](const auto &run, int i) {
    if (rows[i][STRESS] != 0.0) body.stressed.push_back({i, run.slot});
  });
}

void FixMPMDashpot::add_stages(MPMPlan &plan, MPMPlan::Place place)
{
  if (place != MPMPlan::AFTER_SOLVE ||
      std::none_of(plan.fields.begin(), plan.fields.end(), [](const MPMField *field) {
        return field->options.watches_gain();
      }))
    return;
  plan.together("work of supports", {Data::VELOCITY, Data::NODES, Data::BLOCKS, Data::OWN},
                {Data::OWN}, [this] {
                  for (const auto &body : bodies) tell_watch(body);
                });
}

/** Calls f(node, N, r) for the nodes around a position with their functions N and their vectors
 *  from it, in node spacings. slot: of the block where the last search began, or -1. */
template <class F>
static void visit_nodes(const MPMField &field, const double *x, int &slot, const F &f)
{
  const auto &lattice = field.lattice;
  const Grid &grid = field.grid;
  const MPMStencil stencil(field);
  int base[3] = {0, 0, 0}, count[3] = {1, 1, 1}, k[3], b[3];
  double t[3] = {0.0, 0.0, 0.0}, w[3][4] = {{1.0}, {1.0}, {1.0}};
  for (int d = 0; d < lattice.dim; d++) {
    t[d] = (x[d] - lattice.origin[d]) / lattice.h;
    count[d] = stencil.weights(t[d], base[d], w[d]);
  }
  for (int d = 0; d < 3; d++) b[d] = base[d] >> grid.shift_bits;
  if (slot < 0 || !std::equal(b, b + 3, grid.blocks[slot].b)) slot = grid.find(b);
  for (k[0] = 0; k[0] < count[0]; k[0]++)
    for (k[1] = 0; k[1] < count[1]; k[1]++)
      for (k[2] = 0; k[2] < count[2]; k[2]++) {
        const int index[3] = {base[0] + k[0], base[1] + k[1], base[2] + k[2]};
        const double N = w[0][k[0]] * w[1][k[1]] * w[2][k[2]],
                     r[3] = {index[0] - t[0], index[1] - t[1], index[2] - t[2]};
        const int64_t node = slot < 0 ? grid.locate(index)
                                      : grid.locate_near(grid.blocks[slot], index);
        if (node >= 0 && N > 0.0) f(node, N, r);
      }
}

void FixMPMDashpot::place_marks(Body &body)
{
  int slot = -1;
  body.marks.clear();
  body.nodes.clear();
  visit_marks(body, [&](int i, const double *x) {
    const int first = (int) body.nodes.size();
    visit_nodes(*body.field, x, slot, [&](int64_t node, double N, const double *r) {
      body.nodes.push_back({body.canonical[node], N, N, {r[0], r[1], r[2]}});
    });
    body.marks.push_back({i, first, (int) body.nodes.size()});
  });
}

/** Calls f(point, node, function) for the nodes around the places of marks and below them, a cell
 *  after the other. */
template <class F> void FixMPMDashpot::visit_below(const Body &body, const F &f) const
{
  const auto &lattice = body.field->lattice;
  int slot = -1;
  visit_marks(body, [&](int i, const double *x) {
    for (int j = 0; j <= DEPTH; j++) {
      double y[3] = {x[0], x[1], x[2]};
      for (int d = 0; d < lattice.dim; d++) y[d] -= j * lattice.h * rows[i][NORMAL + d];
      visit_nodes(*body.field, y, slot, [&](int64_t node, double N, const double *) {
        f(i, body.canonical[node], N);
      });
    }
  });
}

/** Forces that would accelerate nodes next to the surface in the first step, at rest those that
 *  walls had borne but for what the support has on points: each node gives it to the marks that see
 *  it, from the surface down, by their functions. Where surfaces of several fixes meet at an edge,
 *  the marks of all of them share, or else both would bear it. */
void FixMPMDashpot::complete_supports(double dt)
{
  std::vector<FixMPMDashpot *> all;
  for (auto *other : find_fixes<FixMPMDashpot>(lmp))
    if (other->fresh) all.push_back(other);
  for (std::size_t b = 0; b < bodies.size(); b++) {
    MPMField &field = *bodies[b].field;
    NodeField &sums = *bodies[b].rates;
    sums.zero();
    for (const auto *other : all)
      other->visit_below(other->bodies[b], [&](int i, int64_t node, double N) {
        sums.at(node)[0] += other->rows[i][AREA] * N;
      });
    field.nodes.sum(sums);
    for (auto *other : all)
      other->visit_below(other->bodies[b], [&](int i, int64_t node, double N) {
        const double *const record = field.grid.record(node);
        const double share = N * record[3] / (dt * sums.at(node)[0]);
        for (int d = 0; d < field.lattice.dim; d++)
          other->rows[i][LACK + d] -= share * (record[d] - record[4 + d]);
      });
  }
  for (auto *other : all) other->fresh = false;
}

/** Sums of A Z at the nodes: xx yy zz xy xz yz, over the mass rates of their velocities. */
void FixMPMDashpot::find_rates(Body &body)
{
  const int dim = body.field->lattice.dim;
  body.rates->zero();
  for (const auto &mark : body.marks) {
    const double *const row = rows[mark.point], *const n = row + NORMAL,
                        scale = row[AREA] * row[DENSITY];
    double Z[6];
    for (int c = 0; c < 6; c++)
      Z[c] = scale * ((speed_p - speed_s) * n[ROW[c]] * n[COLUMN[c]] + (c < dim ? speed_s : 0.0));
    for (int k = mark.first; k < mark.last; k++) {
      double *const to = body.rates->at(body.nodes[k].number);
      for (int c = 0; c < 6; c++) to[c] += body.nodes[k].function * Z[c];
    }
  }
  body.field->nodes.sum(*body.rates);
}

/** Weights of the nodes of a mark, and a along its normal and in its plane. False where no node can
 *  take an impulse. */
bool FixMPMDashpot::weigh(Body &body, const Mark &mark, double dt, double *damping) const
{
  Grid &grid = body.field->grid;
  const int dim = grid.lattice.dim;
  Node *const first = body.nodes.data() + mark.first, *const last = body.nodes.data() + mark.last;
  const auto &options = body.field->options;
  const double fastest = is_mls(options.shape, options.transfer) && !options.strains_by_gradient()
      ? FASTEST_MLS
      : FASTEST;
  const int i = mark.point;
  const double most = fastest * (speed_p + (dim - 1) * speed_s) / grid.lattice.h *
      rows[i][DENSITY] * atom->vfrac[i] / atom->rmass[i];
  double total = 0.0, center[3] = {0.0, 0.0, 0.0}, spread[3] = {0.0, 0.0, 0.0};
  for (Node *node = first; node < last; node++) {
    const double mass = grid.record(node->number)[3], *const L = body.rates->at(node->number);
    const double rate = L[0] + L[1] + L[2];
    node->weight = mass > 0.0 ? node->function : 0.0;
    if (rate > most * mass) node->weight *= most * mass / rate * (most * mass / rate);
    total += node->weight;
  }
  if (!(total > 0.0)) return false;
  for (Node *node = first; node < last; node++) {
    node->weight /= total;
    for (int d = 0; d < dim; d++) {
      center[d] += node->weight * node->r[d];
      spread[d] += node->weight * node->r[d] * node->r[d];
    }
  }
  double K[6] = {};
  for (Node *node = first; node < last; node++) {
    double factor = 1.0;
    for (int d = 0; d < dim; d++) {
      const double variance = spread[d] - center[d] * center[d];
      if (std::fabs(center[d]) < 0.5 * variance)
        factor -= center[d] * (node->r[d] - center[d]) / variance;
    }
    node->weight *= factor;
    if (node->weight == 0.0) continue;
    const double share =
        node->weight * node->weight / (node->function * grid.record(node->number)[3]);
    for (int c = 0; c < 6; c++) K[c] += share * body.rates->at(node->number)[c];
  }
  const double *const n = rows[mark.point] + NORMAL;
  const double along = K[0] * n[0] * n[0] + K[1] * n[1] * n[1] + K[2] * n[2] * n[2] +
      2.0 * (K[3] * n[0] * n[1] + K[4] * n[0] * n[2] + K[5] * n[1] * n[2]);
  damping[0] = dt * along;
  damping[1] = std::max(0.0, dt * (K[0] + K[1] + K[2] - along) / (dim - 1));
  return true;
}

/** Impulses of the dashpots on the nodes. */
void FixMPMDashpot::push(Body &body, double dt)
{
  Grid &grid = body.field->grid;
  const int dim = grid.lattice.dim;
  body.pushes->zero();
  for (const auto &mark : body.marks) {
    const double *const row = rows[mark.point], *const n = row + NORMAL;
    double a[2];
    if (!weigh(body, mark, dt, a)) continue;
    double begin[3] = {0.0, 0.0, 0.0}, change[3] = {0.0, 0.0, 0.0};
    for (int k = mark.first; k < mark.last; k++) {
      const double *const record = grid.record(body.nodes[k].number), w = body.nodes[k].weight;
      for (int d = 0; d < dim && w != 0.0; d++) {
        begin[d] += w * record[4 + d];
        change[d] += w * (record[d] - record[4 + d]);
      }
    }
    if (free_field) {    // relative to the column, which has the same laws
      const int axis = free_field->axis;
      double old[3], more[3];
      free_field->motion(body.field->frame->places()[mark.point][axis] + row[WAY + axis], old,
                         more);
      for (int d = 0; d < dim; d++) {
        begin[d] -= old[d];
        change[d] -= more[d];
      }
    }
    for (int d = 0; d < dim; d++) {
      begin[d] -= 2.0 * arriving[d];
      if (relax > 0.0) begin[d] += row[MOTION + d] / relax;
    }
    // a traction is one of the dashpots at a velocity less, but for a fluid, which has none in the
    // plane
    const double lack = dot(row + LACK, n);
    double along[3] = {0.0, 0.0, 0.0};
    for (int d = 0; d < dim; d++) {
      along[d] = row[LACK + d] - lack * n[d];
      begin[d] -= lack * n[d] / (row[DENSITY] * speed_p);
      if (speed_s > 0.0) begin[d] -= along[d] / (row[DENSITY] * speed_s);
    }
    // mean over the step: along the normal, and all as if it were in the plane
    double mean[2][3];
    for (int k = 0; k < 2; k++) {
      const bool small = a[k] < 1.0e-4;
      const double phi = small ? 1.0 - 0.5 * a[k] : -std::expm1(-a[k]) / a[k];
      const double rest = small ? 0.5 - a[k] / 6.0 : (1.0 - phi) / a[k];
      for (int d = 0; d < 3; d++) mean[k][d] = phi * begin[d] + rest * change[d];
    }
    const double normal = speed_p * dot(mean[0], n) - speed_s * dot(mean[1], n);
    double impulse[3];
    for (int d = 0; d < dim; d++)
      impulse[d] = -row[AREA] * dt *
          (row[DENSITY] * (normal * n[d] + speed_s * mean[1][d]) -
           (speed_s > 0.0 ? 0.0 : along[d]));
    for (int k = mark.first; k < mark.last; k++) {
      double *const to = body.pushes->at(body.nodes[k].number);
      for (int d = 0; d < dim; d++) to[d] += body.nodes[k].weight * impulse[d];
    }
  }
  body.field->nodes.sum(*body.pushes);
}

/** Work of impulses is that of the mean of the old and the new velocity, as for forces. */
void FixMPMDashpot::apply(Body &body, double dt)
{
  Grid &grid = body.field->grid;
  auto &ledger = body.field->ledger;
  const int dim = grid.lattice.dim;
  double done = 0.0;
  for (int64_t node = 0; node < grid.nnodes(); node++) {
    const double *const impulse = body.pushes->at(node);
    double *const record = grid.record(node), change[3] = {0.0, 0.0, 0.0};
    if ((impulse[0] == 0.0 && impulse[1] == 0.0 && impulse[2] == 0.0) || !(record[3] > 0.0))
      continue;
    const bool owned = grid.owns(node);
    for (int d = 0; d < dim; d++) {
      change[d] = impulse[d] / record[3];
      record[d] += change[d];
      if (!owned) continue;
      done += 0.5 * impulse[d] * (record[d] + record[4 + d]);
      sums[d] += impulse[d] / (dt * force->ftm2v);
    }
    if (owned && ledger.on) ledger.note_push(record, change);
  }
  work += done;
  ledger.boundary += done * force->mvv2e;
  ledger.driven += done * force->mvv2e;
  if (relax > 0.0)
    for (const auto &mark : body.marks)
      for (int k = mark.first; k < mark.last; k++)
        for (int d = 0; d < dim; d++)
          rows[mark.point][MOTION + d] +=
              dt * body.nodes[k].weight * grid.record(body.nodes[k].number)[d];
}

void FixMPMDashpot::act(double dt, Stage stage)
{
  if (stage != STEP) return;
  std::fill_n(sums, 3, 0.0);
  sums_known = false;
  if (fresh) complete_supports(dt);
  for (auto &body : bodies) {
    place_marks(body);
    find_rates(body);
    push(body, dt);
    apply(body, dt);
  }
}

/** The energy watch knows the work of forces on points. Those of the support have a stress besides,
 *  whose work is counted here as the ledger does, at the mean of the velocities of nodes before and
 *  after the step. */
void FixMPMDashpot::tell_watch(const Body &body)
{
  MPMField &field = *body.field;
  const MPMStencil stencil(field);
  const auto &options = field.options;
  const int dim = field.lattice.dim;
  const bool mls = is_mls(options.shape, options.transfer) && !options.strains_by_gradient();
  const double moment = mls ? shape_constants[options.shape].inv_moment / field.lattice.h : 0.0;
  double power = 0.0;
  field.nodes.complete_velocities();
  for (const auto &[i, slot] : body.stressed) {
    double L[3][3] = {}, F[3][3], inverse[3][3], tau[6] = {}, rate = 0.0;
    stencil.visit(field.grid.blocks[slot], i, [&](const MPMStencil::Node &node) {
      const double *const record = field.grid.record(node.number);
      for (int d = 0; d < dim; d++)
        for (int e = 0; e < dim; e++)
          L[d][e] += 0.5 * (record[d] + record[4 + d]) *
              (mls ? -moment * node.weight * node.r[e] : node.gradient[e]);
    });
    if (field.frame->is_total()) {    // to the present configuration
      field.frame->lattice_F(i, F);
      MathExtra::invert3(F, inverse);
      std::copy_n(L[0], 9, F[0]);
      MathExtra::times3(F, inverse, L);
    }
    add_stress(field, i, 1, tau);
    for (int c = 0; c < 6; c++)
      rate += 0.5 * (c < 3 ? 1.0 : 2.0) * tau[c] * (L[ROW[c]][COLUMN[c]] + L[COLUMN[c]][ROW[c]]);
    power -= atom->vfrac[i] * rate;
  }
  field.ledger.driven += field.step_dt() * power / force->nktv2p;
}

/** The support, and waves that come in at this time, around which the velocities of nodes are half
 *  a step before and behind. */
void FixMPMDashpot::post_force(int)
{
  const bool any = std::any_of(incoming, incoming + 3, [](const NumberOrVariable &v) {
    return !v.variable.empty();
  });
  evaluate_in_step(lmp, has_incoming && any, [this]() {
    for (int d = 0; d < 3 && has_incoming; d++) arriving[d] = evaluate(lmp, incoming[d]);
  });
  std::fill_n(sums + 3, NSUM - 3, 0.0);
  sums_known = false;
  for (int i = 0; i < atom->nlocal; i++) {
    double *const row = rows[i];
    sums[6] += row[AREA];
    if (free_field && row[SHARE] != 0.0) {
      double t[3];
      column_traction(i, t);
      for (int d = 0; d < 3; d++) row[HELD + d] = row[REST + d] + t[d];
    }
    for (int d = 0; d < 3 && supports; d++) {
      const double share = row[SHARE] * row[HELD + d];
      atom->f[i][d] += share;
      sums[3 + d] += share;
      sums[7 + d] += row[AREA] * row[LACK + d] / force->ftm2v;
    }
  }
}

bool FixMPMDashpot::adds_stress(const MPMField &, int first, int last) const
{
  for (int i = first; i < last && supports; i++)
    if (rows[i][STRESS] != 0.0) return true;
  return false;
}

void FixMPMDashpot::add_stress(const MPMField &field, int first, int n, double *tau) const
{
  for (int i = first; i < first + n && supports; i++, tau += 6) {
    const double *const row = rows[i];
    if (row[STRESS] == 0.0) continue;
    MPMFace::add_stress(row + HELD, row + NORMAL,
                        force->nktv2p * row[STRESS] * field.points->jacobian(i), tau);
  }
}

double FixMPMDashpot::compute_scalar()
{
  double all;
  MPI_Allreduce(&work, &all, 1, MPI_DOUBLE, MPI_SUM, world);
  return all * force->mvv2e;
}

double FixMPMDashpot::compute_vector(int k)
{
  if (!sums_known) MPI_Allreduce(sums, all_sums, NSUM, MPI_DOUBLE, MPI_SUM, world);
  sums_known = true;
  if (k < 3) return all_sums[k] + all_sums[3 + k];
  return k < 6 ? all_sums[k] + all_sums[4 + k] : all_sums[k];
}

double FixMPMDashpot::memory_usage()
{
  double bytes = FixMPMState::memory_usage();
  for (const auto &body : bodies)
    bytes += body.marks.capacity() * sizeof(Mark) + body.nodes.capacity() * sizeof(Node) +
        body.canonical.capacity() * sizeof(int64_t);
  return bytes;
}

void FixMPMDashpot::write_restart(FILE *fp)
{
  std::vector<double> totals = {work};
  write_totals(fp, world, totals,
               {defined ? 1.0 : 0.0, supports ? 1.0 : 0.0, fresh ? 1.0 : 0.0, known});
  work = totals[0];
}

void FixMPMDashpot::restart(char *buf)
{
  const auto *const list = (const double *) read_state(lmp, id, buf, 5 * sizeof(double));
  work = comm->me == 0 ? list[0] : 0.0;
  defined = list[1] != 0.0;
  supports = list[2] != 0.0;
  fresh = list[3] != 0.0;
  known = list[4];
}
