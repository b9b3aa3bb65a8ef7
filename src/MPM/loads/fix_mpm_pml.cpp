/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/* ----------------------------------------------------------------------
   In a layer the coordinates are stretched by complex factors s_j = 1 + d_j/(i omega) (U. Basu,
   A.K. Chopra, Comput. Methods Appl. Mech. Eng. 192 (2003) 1337; Int. J. Numer. Methods Eng. 59
   (2004) 1039). With s = s_x s_y s_z, the equation of motion of the layer times s, and the strain,
   are

     s rho (i omega)^2 u_i = d/dx_j (s/s_j sigma_ij),
     sigma = C : sym G,   G_ij = (1/s_j) du_i/dx_j

   In time, and in the weak form of points, this is

     dG_ij/dt = dv_i/dx_j - d_j G_ij
     m a_i = -V (sigma_ij + sum_{k!=j} d_k S_ij + prod_{k!=j} d_k SS_ij) dN/dx_j - m (e_1 v_i + e_2
     u_i + e_3 U_i)

   where S is the integral of sigma over time and SS that of S, U that of u, and e_1, e_2, e_3 are
   sum, sum of products of two, and product of the d_j (in 2d, of two axes). The law of the material
   gets the rate dG/dt in place of the velocity gradient. Points thus have any law that is linear in
   small strains, and stress is what it is in other points. All is for the change since the start:
   sigma is the stress less that at the start, which stays in the internal forces.

   With mix, d_j has a share of the others (K.C. Meza-Fajardo, A.S. Papageorgiou, Bull. Seismol.
   Soc. Am. 98 (2008) 1811).

   Time. Velocities are at the middle of steps and G, stress, and u at their ends, as for other
   points. S and U are kept at the middle, and half a step is added to them: S^n = S^(n-1/2) + dt/2
   sigma^n. The damping e_1 v takes the mean of the old and the new velocity at nodes. G decays
   exactly: dt dG/dt = (1 - exp(-d dt))/d (L - d G). For a wave in a uniform layer the largest
   stable step falls from 2/omega by the factor (1 + e_2/omega^2)^(-1/2) at the most, from the
   eigenvalues of a step.

   Energy. What is lost is the work of the forces on nodes that other points do not have, and V
   sigma : (dv/dx - dG/dt).
------------------------------------------------------------------------- */

#include "loads/fix_mpm_pml.h"

#include "base/mpm_options.h"
#include "base/mpm_points.h"
#include "field/fix_mpm_material.h"
#include "field/mpm_field.h"
#include "field/mpm_passes.h"
#include "field/mpm_point_batches.h"
#include "field/mpm_stencil.h"
#include "material/batch_kernels.h"
#include "material/material.h"

#include "atom.h"
#include "comm.h"
#include "domain.h"
#include "error.h"
#include "force.h"
#include "modify.h"

#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;
using namespace MPM_NS;
using Data = MPMStageData;    // what stages read and write

static const char *const FACE[] = {"xlo", "xhi", "ylo", "yhi", "zlo", "zhi"};

static constexpr int COLUMN[3][3] = {{0, 3, 4}, {3, 1, 5}, {4, 5, 2}};    // of a stress
static constexpr double SMALL_STRAIN = 0.02;    // more is not what layers are made for

/** fix ID group mpm/pml keyword values ... */
Options MPMPMLOptions::declare(int dim)
{
  using namespace option;
  Options o("fix mpm/pml");
  for (int face = 0; face < NFACE; face++)
    o.add(FACE[face],
          {integer(cells[face], "N", POSITIVE,
                   "thickness of the layer next to this face of the box, in cells")})
        .once()
        .standard("none");
  o.add("reflection",
        {number(reflection, "R", {0.0, 1.0, false, false}, "",
                "ratio of the amplitude after a wave crosses the layer along its normal, there and "
                "back")});
  o.add("exponent",
        {number(exponent, "n", POSITIVE, "", "damping grows with this power of the depth")});
  o.add("speed",
        {number(speed, "c", POSITIVE, "velocity",
                "speed of the waves for which the damping is chosen")})
      .standard("speed of the fastest pressure wave in the layers at the start");
  o.add("mix",
        {number(mix, "p", {0.0, 1.0, true, true}, "",
                "share of the damping along an axis that also acts along the other axes")});
  o.refuse([=] {
    return OptionRules{{std::all_of(cells, cells + NFACE,
                                    [](int n) {
                                      return n == 0;
                                    }),
                        "", "has no layer: use xlo, xhi, ylo, yhi, zlo, or zhi"},
                       {dim == 2 && cells[4] > 0, "zlo", "has no cells in 2d"},
                       {dim == 2 && cells[5] > 0, "zhi", "has no cells in 2d"}};
  });
  return o;
}

FixMPMPML::FixMPMPML(LAMMPS *lmp, int narg, char **arg) : FixMPMState(lmp, narg, arg)
{
  Options options = declare(domain->dimension);
  read_options(lmp, options, narg, arg, 3);
  scalar_flag = vector_flag = 1;
  size_vector = 2;
  global_freq = 1;
  extscalar = 1;
  extvector = 0;
  restart_global = 1;
  dynamic_group_allow = 0;
  state.declare(rows, "layer", domain->dimension == 2 ? WIDTH_2D : WIDTH_3D);
  keep_arrays();
}

void FixMPMPML::init()
{
  require_field(lmp, *this);
  refuse_second(lmp, *this, "one of them can have layers at all faces");
  static const struct {
    const char *style, *remedy;
  } OTHERS[] = {{"pore", "faces further away, or soil without water"},
                {"mixture", "faces further away, or soil without water"},
                {"incompressible", "faces further away"},
                {"deform", "fix mpm/dashpot, or faces further away"},
                {"heat", "fix mpm/dashpot, or faces further away"}};
  for (const auto &[style, remedy] : OTHERS)
    if (!modify->get_fix_by_style(std::string("^mpm/") + style + "$").empty())
      error->all(FLERR, Error::NOLASTLINE,
                 "Fix mpm/pml {} has layers of one elastic material, and there is a fix mpm/{}: "
                 "use {}",
                 id, style, remedy);
  for (int face = 0; face < NFACE; face++)
    if (cells[face] > 0 && domain->periodicity[face / 2])
      error->all(FLERR, Error::NOLASTLINE,
                 "Fix mpm/pml {}: the box is periodic at {}: use boundary f there", id, FACE[face]);
}

void FixMPMPML::init_physics(MPMPlan &plan)
{
  bodies.clear();
  is_inside.clear();
  warned = false;
  for (auto *field : plan.fields) {
    const auto &options = field->options;
    refuse_field(
        lmp, *this, *field,
        {{options.stress_before(), "this scheme",
          "stress must be that of the end of the step: use scheme usl or musl"},
         {options.axisymmetric, "axisymmetric", "layers are flat: use fix mpm/dashpot"},
         {has_domain(options.shape), "shape cpdi", "use another shape"},
         {options.averages_strain() || options.averages_stress(), "locking",
          "the strain of layers is not averaged: remove it"},
         {options.modified_edges, "edges modified", "use edges plain, the default"},
         {options.flip > 0.0 || options.has_fmpm(), "this transfer",
          "short waves that it keeps grow in layers: use transfer apic, which is the default"}});
    for (int axis = 0; axis < field->lattice.dim; axis++)
      if (thickness(*field, 2 * axis) + thickness(*field, 2 * axis + 1) > domain->prd[axis])
        error->all(FLERR, Error::NOLASTLINE,
                   "Fix mpm/pml {}: the layers at {} and {} are thicker than the box, which has "
                   "{:.6g} cells there",
                   id, FACE[2 * axis], FACE[2 * axis + 1], domain->prd[axis] / field->lattice.h);
    field->keep_old_velocities();
    field->stretching.push_back(this);
    bodies.push_back({field, &field->nodes.add_field("layers of " + std::string(id), 4), {}});
  }
}

/** What this run starts with: which points are in the layers, by where they are now, and their
 *  stress. */
double FixMPMPML::thickness(const MPMField &field, int face) const
{
  return cells[face] * field.lattice.h;
}

/** Depth in a layer as a share of its thickness, at most 1; not positive: outside. */
double FixMPMPML::depth(const MPMField &field, int face, const double *x) const
{
  if (cells[face] == 0) return 0.0;
  const int axis = face / 2;
  const double away = face % 2 ? domain->boxhi[axis] - x[axis] : x[axis] - domain->boxlo[axis];
  return std::min(1.0, 1.0 - away / thickness(field, face));
}

void FixMPMPML::setup(int)
{
  if (!defined) define();
  post_run();
}

void FixMPMPML::define()
{
  const auto *const points = MPMPoints::get(atom);
  const int dim = domain->dimension;
  const auto belongs = [&](const MPMField &field, int i) {
    return (atom->mask[i] & groupbit) && field.is_point(i) && !field.is_element_node(i);
  };
  const auto deepest = [&](const MPMField &field, int i) {
    double most = 0.0;
    for (int face = 0; face < 2 * dim; face++)
      most = std::max(most, depth(field, face, atom->x[i]));
    return most;
  };

  double mine = speed, c = speed;
  if (speed == 0.0) {
    double waves[BATCH];
    visit_point_batches(lmp, groupbit, [&](const Batch &b, const int *list, const auto &material) {
      material.material->wave_speed(b, waves);
      for (int p = 0; p < b.n; p++)
        for (const auto &body : bodies)
          if (belongs(*body.field, list[p]) && deepest(*body.field, list[p]) > 0.0)
            mine = std::max(mine, waves[p]);
    });
    MPI_Allreduce(&mine, &c, 1, MPI_DOUBLE, MPI_MAX, world);
  }

  double count[NFACE + 1] = {}, all[NFACE + 1];
  largest = 0.0;
  for (const auto &body : bodies) {
    const MPMField &field = *body.field;
    double most[NFACE] = {};
    for (int face = 0; face < 2 * dim; face++)
      if (cells[face] > 0) {
        most[face] =
            0.5 * (exponent + 1.0) * c * std::log(1.0 / reflection) / thickness(field, face);
        largest = std::max(largest, most[face]);
      }
    for (int i = 0; i < atom->nlocal; i++) {
      if (!belongs(field, i) || !(deepest(field, i) > 0.0)) continue;
      double d[3] = {0.0, 0.0, 0.0}, *const row = rows[i];
      for (int face = 0; face < 2 * dim; face++) {
        const double at = depth(field, face, atom->x[i]);
        if (!(at > 0.0)) continue;
        d[face / 2] = most[face] * std::pow(at, exponent);
        count[face]++;
      }
      const double sum = d[0] + d[1] + d[2];
      for (int k = 0; k < dim; k++) row[DAMPING + k] = d[k] + mix * (sum - d[k]);
      std::copy_n(points->tau[i], 6, row + TAU);
      domain->unmap(atom->x[i], atom->image[i], row + START);
      count[NFACE]++;
    }
  }
  MPI_Allreduce(count, all, NFACE + 1, MPI_DOUBLE, MPI_SUM, world);
  for (int face = 0; face < NFACE; face++)
    if (cells[face] > 0 && all[face] == 0.0)
      error->all(
          FLERR, Error::NOLASTLINE,
          "Fix mpm/pml {}: no point of its group is within {} cells of {}: bodies must go on "
          "up to this face of the box",
          id, cells[face], FACE[face]);
  defined = true;
  for (auto &body : bodies) body.field->map->valid = false;
  if (comm->me == 0)
    utils::logmesg(lmp,
                   "Fix mpm/pml {}: {:.0f} points, damping up to {:.6g} for the speed {:.6g}\n", id,
                   all[NFACE], largest, c);
}

/** Have points of the layers been deleted, or strained more than layers are made for? */
void FixMPMPML::post_run()
{
  double mine[2] = {0.0, 0.0}, strain = 0.0, most;
  for (int i = 0; i < atom->nlocal; i++) {
    const double *const row = rows[i];
    if (row[DAMPING] + row[DAMPING + 1] + row[DAMPING + 2] == 0.0) continue;
    mine[0]++;
    for (int k = 0; k < 9; k++) strain = std::max(strain, std::fabs(row[G + k]));
  }
  double all;
  MPI_Allreduce(mine, &all, 1, MPI_DOUBLE, MPI_SUM, world);
  MPI_Allreduce(&strain, &most, 1, MPI_DOUBLE, MPI_MAX, world);
  if (comm->me == 0 && all < known)
    error->warning(FLERR, "Fix mpm/pml {}: {:.0f} of the {:.0f} points of its layers are gone", id,
                   known - all, known);
  if (comm->me == 0 && most > SMALL_STRAIN && !warned)
    error->warning(FLERR,
                   "Fix mpm/pml {}: strain in its layers is up to {:.3g}, and they are matched to "
                   "small strain only: put them further away, or use fix mpm/dashpot",
                   id, most);
  warned = most > SMALL_STRAIN;
  known = all;
}

void FixMPMPML::topology_changed(MPMField &field)
{
  Body &body = *std::find_if(bodies.begin(), bodies.end(), [&](const Body &b) {
    return b.field == &field;
  });
  is_inside.resize(atom->nmax);
  body.points.clear();
  each_point(field, [&](const auto &run, int i) {
    const double *const d = rows[i] + DAMPING;
    is_inside[i] = run.material && d[0] + d[1] + d[2] > 0.0;
    if (is_inside[i]) body.points.push_back({i, run.slot});
  });
}

void FixMPMPML::add_stages(MPMPlan &plan, MPMPlan::Place place)
{
  const auto each = [&](const char *name, void (FixMPMPML::*what)(Body &)) {
    plan.each(name,
              {Data::POSITION, Data::VELOCITY, Data::DEFORMATION, Data::STRESS, Data::MASS,
               Data::NODES, Data::BLOCKS, Data::OWN},
              {Data::NODES, Data::OWN}, [this, what](MPMField &field) {
                for (auto &body : bodies)
                  if (body.field == &field) (this->*what)(body);
              });
  };
  if (place == MPMPlan::BEFORE_SOLVE) each("forces of matched layers", &FixMPMPML::find_forces);
  if (place == MPMPlan::AFTER_MOMENTUM) each("matched layers", &FixMPMPML::apply);
  if (place == MPMPlan::AFTER_SOLVE) each("work of matched layers", &FixMPMPML::count_work);
}

/** Forces on nodes besides those of other points, and the damping of their mass. */
void FixMPMPML::find_forces(Body &body)
{
  MPMField &field = *body.field;
  NodeField &nodes = *body.pushes;
  const MPMStencil stencil(field);
  const auto &options = field.options;
  const int dim = field.lattice.dim;
  const bool mls = is_mls(options.shape, options.transfer) && !options.strains_by_gradient();
  const double moment = mls ? shape_constants[options.shape].inv_moment / field.lattice.h : 0.0;
  const TransferStep step = field.step_data();
  const double dt = step.dt;
  nodes.zero();
  for (const auto &[i, slot] : body.points) {
    double *const row = rows[i], mass = atom->rmass[i];
    const double *const d = row + DAMPING, *const tau = field.points->tau[i];
    const double volume = atom->vfrac[i] * step.stress_scale;
    double S[6], SS[6] = {}, E[3][3] = {}, f[3] = {0.0, 0.0, 0.0};
    for (int c = 0; c < 6; c++) {
      const double change = tau[c] - row[TAU + c];
      S[c] = row[SUM + c] + 0.5 * dt * change;
      row[SUM + c] += dt * change;
    }
    if (dim == 3)
      for (int c = 0; c < 6; c++) {
        SS[c] = row[SUM_OF_SUM + c] + 0.5 * dt * S[c];
        row[SUM_OF_SUM + c] += dt * S[c];
      }
    for (int j = 0; j < dim; j++) {
      const int k = (j + 1) % dim, l = (j + 2) % dim;
      const double sum = dim == 3 ? d[k] + d[l] : d[k], product = dim == 3 ? d[k] * d[l] : 0.0;
      for (int r = 0; r < dim; r++)
        E[r][j] = volume * (sum * S[COLUMN[r][j]] + product * SS[COLUMN[r][j]]);
    }
    const double e1 = d[0] + d[1] + d[2], e2 = d[0] * d[1] + d[0] * d[2] + d[1] * d[2],
                 e3 = d[0] * d[1] * d[2];
    double x[3];
    domain->unmap(atom->x[i], atom->image[i], x);
    for (int r = 0; r < dim; r++) {
      const double u = x[r] - row[START + r];
      f[r] = e2 * u;
      if (dim < 3) continue;
      f[r] += e3 * (row[WAY + r] + 0.5 * dt * u);
      row[WAY + r] += dt * u;
    }
    stencil.visit(field.grid.blocks[slot], i, [&](const MPMStencil::Node &node) {
      double *const to = nodes.at(node.number);
      for (int r = 0; r < dim; r++) {
        double force = mass * node.weight * f[r];
        for (int j = 0; j < dim; j++)
          force += E[r][j] * (mls ? -moment * node.weight * node.r[j] : node.gradient[j]);
        to[r] -= force;
      }
      to[3] += mass * node.weight * e1;
    });
  }
  field.nodes.sum(nodes);
}

/** Velocities of nodes with these forces, and the damping at the mean of the old and the new
 *  velocity. */
void FixMPMPML::apply(Body &body)
{
  Grid &grid = body.field->grid;
  const int dim = grid.lattice.dim;
  const double dt = body.field->step_dt();
  for (int64_t node = 0; node < grid.nnodes(); node++) {
    double *const at = body.pushes->at(node), *const record = grid.record(node);
    if (!(at[3] > 0.0) || !(record[3] > 0.0)) continue;
    const double half = 0.5 * dt * at[3] / record[3];
    for (int r = 0; r < dim; r++) {
      const double v = (record[r] + dt * at[r] / record[3] - half * record[4 + r]) / (1.0 + half);
      at[r] = record[3] * (v - record[r]);
      record[r] = v;
    }
  }
}

/** Of these forces, at the mean of the velocities before and after the step. */
void FixMPMPML::count_work(Body &body)
{
  Grid &grid = body.field->grid;
  const int dim = grid.lattice.dim;
  double done = 0.0;
  for (int64_t node = 0; node < grid.nnodes(); node++) {
    const double *const at = body.pushes->at(node), *const record = grid.record(node);
    if (!(at[3] > 0.0) || !grid.owns(node)) continue;
    for (int r = 0; r < dim; r++) done += 0.5 * at[r] * (record[r] + record[4 + r]);
  }
  work_of_nodes += done * force->mvv2e;
}

/** Strain in stretched coordinates. */
bool FixMPMPML::stretches(int first, int n) const
{
  const auto *const inside = is_inside.data() + first;
  return std::any_of(inside, inside + n, [](char is) {
    return is;
  });
}

void FixMPMPML::stretch_gradients(MPMField &field, int first, int n, double dt, double *L)
{
  const int dim = field.lattice.dim;
  double lost = 0.0;
  for (int p = 0; p < n; p++, L += dim * dim) {
    if (!is_inside[first + p]) continue;
    double *const row = rows[first + p], *const gradient = row + G, power = 0.0;
    const double *const tau = field.points->tau[first + p];
    for (int j = 0; j < dim; j++) {
      const double d = row[DAMPING + j], a = d * dt;
      const double share = a > 0.0 ? -std::expm1(-a) / a : 1.0;
      for (int r = 0; r < dim; r++) {
        const int k = r + dim * j;
        const double stretched = share * (L[k] - d * gradient[k]);
        power += tau[COLUMN[r][j]] * (L[k] - stretched);
        gradient[k] += dt * stretched;
        L[k] = stretched;
      }
    }
    lost += power * atom->vfrac[first + p];
  }
  lost *= dt * force->mvv2e * field.step_data().stress_scale;
  work_of_strain -= lost;
  field.ledger.internal -= lost;
}

/** The speed at which the plain limit of the time step is that of the layer. */
double FixMPMPML::wave_speed(const MPMField &field, int i, double c) const
{
  const double *const d = rows[i] + DAMPING, h = field.lattice.h;
  const double e2 = d[0] * d[1] + d[0] * d[2] + d[1] * d[2];
  return e2 > 0.0 ? std::sqrt(c * c + 0.25 * e2 * h * h) : c;
}

double FixMPMPML::compute_scalar()
{
  const double mine = work_of_nodes + work_of_strain;
  double all;
  MPI_Allreduce(&mine, &all, 1, MPI_DOUBLE, MPI_SUM, world);
  return all;
}

double FixMPMPML::memory_usage()
{
  double bytes = FixMPMState::memory_usage() + (double) is_inside.capacity();
  for (const auto &body : bodies) bytes += (double) body.points.capacity() * sizeof(Body::Point);
  return bytes;
}

void FixMPMPML::write_restart(FILE *fp)
{
  std::vector<double> totals = {work_of_nodes, work_of_strain};
  write_totals(fp, world, totals, {defined ? 1.0 : 0.0, known, largest});
  work_of_nodes = totals[0];
  work_of_strain = totals[1];
}

void FixMPMPML::restart(char *buf)
{
  const auto *const list = (const double *) read_state(lmp, id, buf, 5 * sizeof(double));
  work_of_nodes = comm->me == 0 ? list[0] : 0.0;
  work_of_strain = comm->me == 0 ? list[1] : 0.0;
  defined = list[2] != 0.0;
  known = list[3];
  largest = list[4];
}
