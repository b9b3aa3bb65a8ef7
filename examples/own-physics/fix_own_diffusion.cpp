/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "fix_own_diffusion.h"

#include "atom.h"
#include "comm.h"
#include "domain.h"
#include "error.h"
#include "field/mpm_field.h"
#include "field/mpm_point_map.h"
#include "field/mpm_stencil.h"
#include "lammpsplugin.h"
#include "version.h"

#include <cmath>
#include <cstring>

using namespace LAMMPS_NS;
using namespace MPM_NS;

static const char *const FACES[6] = {"xlo", "xhi", "ylo", "yhi", "zlo", "zhi"};

/* ---------------------------------------------------------------------- */

FixOwnDiffusion::FixOwnDiffusion(LAMMPS *lmp, int narg, char **arg) :
    FixMPMState(lmp, narg, arg), c(nullptr), inflow(0.0)
{
  if (narg < 5) utils::missing_cmd_args(FLERR, "fix own/diffusion", error);
  D = utils::numeric(FLERR, arg[3], false, lmp);
  c0 = utils::numeric(FLERR, arg[4], false, lmp);
  if (!(D > 0.0))
    error->all(FLERR, 3, "Fix own/diffusion diffusivity must be positive: {}", arg[3]);
  for (double &value : held) value = NAN;
  for (int iarg = 5; iarg < narg; iarg += 2) {
    int face = 0;
    while (face < 6 && strcmp(arg[iarg], FACES[face]) != 0) face++;
    if (face == 6) error->all(FLERR, iarg, "Unknown fix own/diffusion keyword: {}", arg[iarg]);
    if (iarg + 1 == narg) utils::missing_cmd_args(FLERR, "fix own/diffusion", error);
    held[face] = utils::numeric(FLERR, arg[iarg + 1], false, lmp);
  }

  // numbers of each point: they go where the point goes, and to restart files
  state.declare(c, "own:c", 4, [this](int, double *row) {
    row[0] = c0;
  });
  keep_arrays();

  restart_global = 1;
  peratom_flag = 1;
  size_peratom_cols = 4;
  peratom_freq = 1;
  array_atom = c;
}

int FixOwnDiffusion::setmask()
{
  return 0;    // called by fix mpm
}

void FixOwnDiffusion::grow_arrays(int nmax)
{
  FixMPMState::grow_arrays(nmax);
  array_atom = c;
}

/* ---------------------------------------------------------------------- */

void FixOwnDiffusion::init_physics(MPMPlan &plan)
{
  nodes.clear();
  for (auto *field : plan.fields) nodes[field] = &field->nodes.add_field(id, WIDTH);
}

void FixOwnDiffusion::add_stages(MPMPlan &plan, MPMPlan::Place place)
{
  using Data = MPMStageData;    // what the stages read and write
  const Data own = {Data::OWN}, points = {Data::POSITION, Data::MASS, Data::BLOCKS, Data::OWN};
  const Data nodes_and_points = {Data::POSITION, Data::MASS, Data::NODES, Data::BLOCKS, Data::OWN};

  if (place == MPMPlan::BEFORE_SOLVE)
    plan.each("scalar to nodes", points, own, [this](MPMField &field) {
      scalar_to_nodes(field);
    });
  if (place == MPMPlan::AFTER_SOLVE)
    plan.each("scalar to points", nodes_and_points, own, [this](MPMField &field) {
      scalar_to_points(field);
    });
}

/* ----------------------------------------------------------------------
   value c_i = sum_p m_p N_ip [c_p + g_p (x_i - x_p)] / m_i, and its rate m_i dc_i/dt =
   -sum_p m_p D grad c . grad N_ip
------------------------------------------------------------------------- */

void FixOwnDiffusion::scalar_to_nodes(MPMField &field)
{
  NodeField &node = *nodes[&field];
  const MPMStencil stencil(field);
  Grid &grid = field.grid;
  node.zero();
  for (const auto &run : field.map->runs)
    for (int i = run.first; i < run.last; i++)
      stencil.visit(grid.blocks[run.slot], i, [&](const MPMStencil::Node &n) {
        double value = c[i][0];
        for (int d = 0; d < 3; d++) value -= c[i][1 + d] * n.r[d] * field.lattice.h;
        node.at(n.number)[VALUE] += atom->rmass[i] * n.weight * value;
      });
  field.nodes.sum(node);
  const double *record = grid.nodes();    // fourth real: mass
  for (int64_t n = 0; n < grid.nnodes(); n++, record += grid.nreal)
    node.at(n)[VALUE] = record[3] > 0.0 ? node.at(n)[VALUE] / record[3] : 0.0;
  field.nodes.complete(node);    // periodic images

  for (const auto &run : field.map->runs)
    for (int i = run.first; i < run.last; i++) {
      double gradient[3] = {0.0, 0.0, 0.0};
      const auto &block = grid.blocks[run.slot];
      stencil.visit(block, i, [&](const MPMStencil::Node &n) {
        for (int d = 0; d < 3; d++) gradient[d] += node.at(n.number)[VALUE] * n.gradient[d];
      });
      stencil.visit(block, i, [&](const MPMStencil::Node &n) {
        double flux = 0.0;
        for (int d = 0; d < 3; d++) flux += gradient[d] * n.gradient[d];
        node.at(n.number)[CHANGE] -= atom->rmass[i] * D * flux;
      });
    }
  field.nodes.sum(node.values.data(), WIDTH, CHANGE, 1);
}

/* ----------------------------------------------------------------------
   points get the new values of the nodes, and their gradient
------------------------------------------------------------------------- */

void FixOwnDiffusion::scalar_to_points(MPMField &field)
{
  NodeField &node = *nodes[&field];
  Grid &grid = field.grid;
  const double dt = field.step_dt();
  const double *record = grid.nodes();
  for (int64_t n = 0; n < grid.nnodes(); n++, record += grid.nreal)
    if (record[3] > 0.0) node.at(n)[CHANGE] *= dt / record[3];
  hold(field);
  field.nodes.complete(node);

  const MPMStencil stencil(field);
  for (const auto &run : field.map->runs)
    for (int i = run.first; i < run.last; i++) {
      memset(c[i], 0, 4 * sizeof(double));
      stencil.visit(grid.blocks[run.slot], i, [&](const MPMStencil::Node &n) {
        const double value = node.at(n.number)[VALUE] + node.at(n.number)[CHANGE];
        c[i][0] += n.weight * value;
        for (int d = 0; d < 3; d++) c[i][1 + d] += n.gradient[d] * value;
      });
    }
}

/* ----------------------------------------------------------------------
   nodes at a face and beyond it have its value, which is of first order
------------------------------------------------------------------------- */

void FixOwnDiffusion::hold(MPMField &field)
{
  NodeField &node = *nodes[&field];
  Grid &grid = field.grid;
  for (int face = 0; face < 6; face++) {
    if (std::isnan(held[face])) continue;
    const int axis = face / 2, outward = face % 2 ? 1 : -1;
    const double at = face % 2 ? domain->boxhi[axis] : domain->boxlo[axis];
    const int plane = (int) std::lround((at - field.lattice.origin[axis]) / field.lattice.h);
    for (std::size_t slot = 0; slot < grid.blocks.size(); slot++)
      for (int n = 0; n < NODES_PER_BLOCK; n++) {
        int index[3];
        grid.node_index(grid.blocks[slot], n, index);
        const int beyond = outward * (index[axis] - plane);
        const double mass = grid.record((int) slot, n)[3];
        if (beyond < 0 || !(mass > 0.0)) continue;
        double *const mine = node.at((int64_t) slot * NODES_PER_BLOCK + n);
        const double more = held[face] - (mine[VALUE] + mine[CHANGE]);
        mine[CHANGE] += more;
        if (grid.blocks[slot].owned >> n & 1) inflow += mass * more;
      }
  }
}

/* ---------------------------------------------------------------------- */

double FixOwnDiffusion::stable_dt(const MPMField &field, tagint &) const
{
  return field.lattice.h * field.lattice.h / (2.0 * field.lattice.dim * D);
}

/* ----------------------------------------------------------------------
   entries of compute mpm/energy: sum of m c, and what of it came through faces
------------------------------------------------------------------------- */

std::vector<MPMPhysics::Account> FixOwnDiffusion::accounts() const
{
  return {{"scalar", true}, {"scalar through faces", false}};
}

void FixOwnDiffusion::account(double *values) const
{
  for (const auto &entry : nodes)
    for (int i = 0; i < atom->nlocal; i++)
      if (entry.first->is_point(i)) values[0] += atom->rmass[i] * c[i][0];
  values[1] += inflow;
}

void FixOwnDiffusion::write_restart(FILE *fp)
{
  double all;
  MPI_Reduce(&inflow, &all, 1, MPI_DOUBLE, MPI_SUM, 0, world);
  if (comm->me) return;
  const int size = sizeof(double);
  fwrite(&size, sizeof(int), 1, fp);
  fwrite(&all, sizeof(double), 1, fp);
}

void FixOwnDiffusion::restart(char *buf)
{
  if (comm->me == 0) memcpy(&inflow, buf, sizeof(double));
}

/* ----------------------------------------------------------------------
   for plugin load
------------------------------------------------------------------------- */

static Fix *create(LAMMPS *lmp, int narg, char **arg)
{
  return new FixOwnDiffusion(lmp, narg, arg);
}

extern "C" void lammpsplugin_init(void *lmp, void *handle, void *regfunc)
{
  lammpsplugin_t plugin;
  plugin.version = LAMMPS_VERSION;
  plugin.style = "fix";
  plugin.name = "own/diffusion";
  plugin.info = "diffusion of a scalar in material points";
  plugin.author = "you";
  plugin.creator.v2 = (lammpsplugin_factory2 *) &create;
  plugin.handle = handle;
  (*(lammpsplugin_regfunc) regfunc)(&plugin, lmp);
}
