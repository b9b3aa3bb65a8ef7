/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/* ----------------------------------------------------------------------
   Bridging domain of S.P. Xiao, T. Belytschko, Comput. Methods Appl. Mech. Eng. 193 (2004) 1645, on
   the nodes of the material points. Across the zone the energy of the system is

     E = sum_i w_i (m_i v_i^2/2 + e_i) + sum_p (1 - w_p) (m_p v_p^2/2 + V_p W_p)

   with a weight w that falls linearly from 1 (atoms only) to 0 (points only). Each atom and point
   keeps the weight of the place where it was when it got it, so that the masses w m are constant.
   With e_i half of the energies of the pairs of atom i, the force of the weighted energy is

     G_i = sum_j (w_i + w_j)/2 f_ij = w_i f_i + g_i,   g_i = sum_j (w_j - w_i)/2 f_ij,

   where g_i, the stress of the atoms times the gradient of w, is what balances the missing stress
   of the points; the sum of all G_i is zero exactly.

   Atoms and points are tied at the nodes, with the shape functions N of the points. A node has the
   masses and forces

     m_a = sum_i N w_i m_i,  f_a = sum_i N G_i;  m_c, f_c: what fix mpm has of the points,

   and the velocities u_a = sum_i N m_i v_i / sum_i N m_i, and u_c likewise, with *full* masses:
   those with the weights in them would be velocities at two different places. Both get the
   acceleration of a common momentum equation and lose their difference as in an inelastic
   collision:

     a = (f_a + f_c)/(m_a + m_c),  d = u_a - U_c
     points: v_p += sum N [dt a + d m_a/(m_a + m_c)],
     atoms:  v_i += dt f_i/m_i + sum N [dt a - dt (sum_i N w_i f_i)/m_a - d m_c/(m_a + m_c)].

   U_c is what points and nodes make of the velocities with which points move, sum N u_c. With FLIP
   these are not v_p but, for a wave number k, smaller by a factor 1 - (k h)^2/4. It is the
   displacements of atoms and points that must agree.

   So only the part of their motion that nodes can represent is changed, thermal motion is not, and
   forces on single atoms are those of the full crystal. The sum of w m v over atoms and points
   changes by the forces from outside only, to round-off. Atoms with w = 0 complete the neighborhood
   of the others: they move with v. Damping acts on v_i - sum N u_a; nodes get the momentum.

   Points have the velocity of the middle of the step, atoms that of the end. The velocity of atoms
   before the step, v_i - dt f_i/(2 m_i), is what it was before the last half of fix nve, and the
   first half is still to come: fix nve must come after fix mpm.
------------------------------------------------------------------------- */

#include "grains/fix_mpm_handshake.h"

#include "atom.h"
#include "base/mpm_options.h"
#include "base/mpm_pair_styles.h"
#include "comm.h"
#include "error.h"
#include "field/fix_mpm_material.h"
#include "field/mpm_block_passes.h"
#include "field/mpm_field.h"
#include "field/mpm_setup_checks.h"
#include "force.h"
#include "math_extra.h"
#include "modify.h"
#include "neigh_list.h"
#include "neighbor.h"
#include "update.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <iterator>

using namespace LAMMPS_NS;
using namespace MPM_NS;

// lanes of a node: with full masses momentum and mass of the atoms, and of the points; with weights
// mass and force of the atoms, and of the forces the part without the gradient of the weights; the
// number of atoms and points that need the other kind at the node; and later what is for the atoms

enum { ATOMS = 0, POINTS = 4, FORCE = 8, MASS = 11, PLAIN = 12, PRESENCE = 15, NREAL = 16 };
enum { CHANGE = 0, VELOCITY = 4 };

// what the masses of atoms and points in the zone may differ by before there is a warning: at the
// ends of a zone of one node spacing, they need not be in the same place

static constexpr double MASS_DIFFERENCE = 0.3;

/** fix ID atoms mpm/handshake FIELD zone AXIS ONE ZERO ... damp RATE. */
Options MPMHandshakeOptions::declare()
{
  using namespace option;
  Options o("fix mpm/handshake");
  o.argument(text(field_name, "field"));
  o.add(
       "zone",
       {word(next.axis, {{"x", Zone::X}, {"y", Zone::Y}, {"z", Zone::Z}}, "axis"),
        number(
            next.one, "one", ANY_NUMBER, "distance",
            "coordinate where the weight of the atoms is 1, and beyond which there are atoms only"),
        number(
            next.zero, "zero", ANY_NUMBER, "distance",
            "coordinate where this weight is 0, and beyond which there are material points only")},
       "may be repeated: the weight is the product of the weights of all zones")
      .then([this] {
        zones.push_back(next);
      })
      .standard("");
  o.add("damp",
        {number(damping, "rate", NOT_NEGATIVE, "1/time",
                "rate at which the fine motion of the atoms is damped at weight 0")});
  o.refuse([=] {
    return OptionRules{
        {zones.empty(), "", "needs at least one zone"},
        {std::any_of(zones.begin(), zones.end(),
                     [](const Zone &z) {
                       return z.one == z.zero;
                     }),
         "zone",
         "has no width: the planes where the weight of the atoms is one and zero must differ"}};
  });
  return o;
}

FixMPMHandshake::FixMPMHandshake(LAMMPS *lmp, int narg, char **arg) : FixMPMState(lmp, narg, arg)
{
  Options options = declare();
  read_options(lmp, options, narg, arg, 3);

  scalar_flag = vector_flag = peratom_flag = 1;
  size_vector = 4;
  size_peratom_cols = 0;
  peratom_freq = global_freq = 1;
  extscalar = extvector = 1;
  comm_forward = 2;
  restart_global = 1;
  state.declare(weight, "mpm/handshake:weight", [](int, double *row) {
    *row = 1.0;
  });
  state.declare(role, "mpm/handshake:role", [](int, double *row) {
    *row = UNKNOWN;
  });
  keep_arrays();
  vector_atom = weight;
}

/** Points get back what they share with atoms, so that another handshake starts from full
 *  masses. */
FixMPMHandshake::~FixMPMHandshake()
{
  for (int i = 0; i < atom->nlocal; i++) {
    if ((role[i] != POINT && role[i] != NEAR_POINT) || !(weight[i] > 0.0)) continue;
    atom->rmass[i] /= weight[i];
    atom->vfrac[i] /= weight[i];
  }
}

void FixMPMHandshake::refuse(bool broken, const std::string &why) const
{
  if (broken) error->all(FLERR, Error::NOLASTLINE, "Fix mpm/handshake {} {}", id, why);
}

void FixMPMHandshake::init()
{
  field = MPMField::find(lmp, field_name);
  refuse(!field, "needs the ID of a fix mpm for its points, not " + field_name);
  for (const auto *elements : modify->get_fix_by_style("^mpm/elements$"))
    refuse(points_in_both(lmp, elements->groupbit, field->fix.groupbit) > 0,
           fmt::format("gives weights to material, and the nodes of fix mpm/elements {} have none: "
                       "give them a fix mpm of their own",
                       elements->id));
  for (const auto &zone : zones) {
    const double width = fabs(zone.one - zone.zero);
    refuse(zone.axis >= field->lattice.dim, "cannot have a zone along z in 2d");
    refuse(width < field->lattice.h,
           fmt::format("has a zone of the width {}, less than the node spacing {}: make it several "
                       "node spacings wide",
                       width, field->lattice.h));
  }
  const auto &given = field->options;
  refuse(is_affine(given.transfer) || given.series != MPMFieldOptions::LUMPED || given.flip < 1.0,
         "needs a field with transfer flip (1.0), which maps points as it maps atoms");
  refuse(given.has_size(), "cannot be used with points of finite size (gimp): use a spline");
  refuse(given.scheme != MPMFieldOptions::USL || given.light > 0.0,
         "needs a field with scheme usl and without light nodes");
  refuse(given.total || given.axisymmetric,
         "cannot be used with frame total or axisymmetric of fix mpm: atoms are in space");
  refuse(given.every > 1, "cannot be used with fix mpm every: atoms and points share each step");
  for (auto *other : modify->get_fix_by_style("^mpm/handshake$"))
    refuse(other != this && dynamic_cast<FixMPMHandshake *>(other)->field_name == field_name,
           fmt::format("and {} have the same field: give one of them all zones", other->id));
  check_pair();

  // atoms are moved by fix nve, after the step of the points

  bool before = true;
  for (auto *ifix : modify->get_fix_list()) {
    if (utils::strmatch(ifix->style, "^mpm$")) before = false;
    refuse(before && ifix->time_integrate && !utils::strmatch(ifix->style, "^mpm"),
           fmt::format("needs positions of the start of the step: define fix {} after fix mpm",
                       ifix->id));
  }
  neighbor->add_request(this, NeighConst::REQ_FULL);
}

/** Weights act on forces between two atoms, so that the force on each must be a sum of these,
 *  central and opposite. Those of EAM are: with the slopes F'_i of the embedding energies
 *
 *    f_ij = -(F'_i rho_j' + F'_j rho_i' + phi') r_ij/r_ij.
 *
 *  The force of sum_i w_i e_i has w_i F'_i in place of (w_i + w_j)/2 F'_i: the same where F' is
 *  uniform, and what F' and w differ by from atom to atom is odd in r_ij, and cancels in the
 *  crystal up to third differences. Styles for accelerators keep F' elsewhere. Forces between three
 *  atoms have no single f_ij. */
void FixMPMHandshake::check_pair()
{
  static const char *const embedded[] = {"eam",           "eam/alloy",     "eam/fs",     "eam/he",
                                         "eam/opt",       "eam/alloy/opt", "eam/fs/opt", "eam/omp",
                                         "eam/alloy/omp", "eam/fs/omp"};
  refuse(!force->pair, "needs a pair style between the atoms");
  eam = {};
  for (const auto &[pair, style] : MPMPairStyle::all(*force)) {
    if (std::find(std::begin(embedded), std::end(embedded), style) != std::end(embedded)) {
      refuse(eam.pair, "cannot be used with two pair styles eam: use one for all elements");
      eam.pair = pair;
    } else
      refuse(pair->manybody_flag || !pair->single_enable,
             "cannot be used with pair style " + style +
                 ", whose forces are not known pair by pair: use a pair potential or eam for the "
                 "atoms of the zone");
  }
}

/** PairEAM::single() returns the pair energy and a share of the embedding energy of its first atom,
 *  and in LAMMPS of 2025 and 2026 the derivative of the former takes the sum of both: the force
 *  over the distance is too large by share/r^2. Since forces are symmetric, two atoms with
 *  different shares show whether this is so; the share alone is what is left at distances far
 *  beyond the cutoff. */
double FixMPMHandshake::Embedded::share(int i, int type) const
{
  const double far = 1.0e4 * pair->cutsq[type][type];
  double unused;
  const double near = pair->single(i, i, type, type, far, 1.0, 1.0, unused);
  return 2.0 * pair->single(i, i, type, type, 4.0 * far, 1.0, 1.0, unused) - near;
}

void FixMPMHandshake::check_embedding()
{
  eam.flaw = 0.0;
  if (!eam.pair) return;
  double found[2] = {-1.0e300, -1.0e300}, all[2];    // largest of it and of its negative
  for (int i = 0; i < atom->nlocal; i++) {
    if (role[i] != COUPLED) continue;
    const int itype = atom->type[i];
    const double share = eam.share(i, itype);
    for (int jj = 0; jj < list->numneigh[i]; jj++) {
      const int j = list->firstneigh[i][jj] & NEIGHMASK;
      const int jtype = atom->type[j];
      if (j >= atom->nlocal || role[j] != COUPLED) continue;
      const double rsq = MathExtra::distsq3(atom->x[i], atom->x[j]);
      const double difference = share - eam.share(j, jtype);
      if (rsq >= eam.pair->cutsq[itype][jtype] || fabs(difference) < 1.0e-3 * fabs(share)) continue;
      double one, other;
      eam.pair->single(i, j, itype, jtype, rsq, 1.0, 1.0, one);
      eam.pair->single(j, i, jtype, itype, rsq, 1.0, 1.0, other);
      const double ratio = (one - other) * rsq / difference;
      found[0] = MAX(found[0], ratio);
      found[1] = MAX(found[1], -ratio);
      break;
    }
  }
  MPI_Allreduce(found, all, 2, MPI_DOUBLE, MPI_MAX, world);
  eam.flaw = all[0] > 0.5 ? 1.0 : 0.0;
  if (!(fabs(all[0] - eam.flaw) < 1.0e-6) || !(fabs(all[1] + eam.flaw) < 1.0e-6))
    error->all(FLERR, Error::NOLASTLINE,
               "Fix mpm/handshake {} does not understand the forces of pair style eam of this "
               "LAMMPS: use a pair potential",
               id);
}

/** Weight of an atom at x; if it is 1, how far inside of the atoms x is; if it is 0, how far it is
 *  beyond the zone. */
static double weight_at(const double *x, const std::vector<MPMHandshakeOptions::Zone> &zones,
                        double &inside, double &beyond)
{
  double w = 1.0;
  inside = 1.0e300;
  beyond = 0.0;
  for (const auto &zone : zones) {
    const double width = fabs(zone.one - zone.zero);
    const double s = (zone.zero - x[zone.axis]) / (zone.zero - zone.one);
    w *= MAX(0.0, MIN(1.0, s));
    inside = MIN(inside, (s - 1.0) * width);
    beyond = MAX(beyond, -s * width);
  }
  return w;
}

/** Atoms and points that have no weight yet get that of the place where they are. */
void FixMPMHandshake::weigh()
{
  // atoms this far from the zone may be neighbors of those in it, points may share nodes with them
  const double reach_atoms = force->pair->cutforce + neighbor->skin,
               reach_nodes = 2.0 * (stencil_order(field->options.shape) + 1) * field->lattice.h;
  bigint none = 0, wrong = 0;
  struct {
    double atoms, points, volume, known;
  } mine = {}, all;    // masses and volume of points in the middle of the zone; who has a weight
  for (int i = 0; i < atom->nlocal; i++) {
    if (role[i] != UNKNOWN) {
      mine.known++;
      continue;
    }
    double inside, beyond;
    const double w = weight_at(atom->x[i], zones, inside, beyond), middle = w * (1.0 - w);
    if (field->is_point(i)) {
      role[i] = beyond < reach_nodes ? NEAR_POINT : POINT;
      weight[i] = 1.0 - w;
      if (!(weight[i] > 0.0)) none++;
      const auto *const material = field->material_of(i);    // none: a node of elements
      const double mass = material ? material->density(i) * atom->vfrac[i] : atom->rmass[i];
      if (fabs(atom->rmass[i] - mass) > 1.0e-3 * mass) wrong++;
      mine.points += middle * atom->rmass[i];
      mine.volume += middle * atom->vfrac[i];
      atom->rmass[i] *= weight[i];
      atom->vfrac[i] *= weight[i];
    } else if ((atom->mask[i] & groupbit) && atom->vfrac[i] == 0.0) {
      role[i] = inside < reach_atoms ? COUPLED : APART;
      weight[i] = w;
      mine.atoms += middle * atom->rmass[i];
    } else {
      role[i] = APART;
      weight[i] = 1.0;
    }
  }
  const auto refuse_points = [&](bigint mine, const std::string &which) {
    bigint all;
    MPI_Allreduce(&mine, &all, 1, MPI_LMP_BIGINT, MPI_SUM, world);
    if (all)
      error->all(FLERR, Error::NOLASTLINE, "Fix mpm/handshake {}: {} material points {}", id, all,
                 which);
  };
  refuse_points(none,
                "are where atoms have the full weight: create points in the zone and beyond it "
                "only");
  refuse_points(wrong,
                "do not have the mass of their density, which is that of the crystal (pair_coeff "
                "of eam gives the mass of its element to all that are there: define it before "
                "create_points, or NULL for the type of points with pair_style hybrid)");
  MPI_Allreduce(&mine, &all, 4, MPI_DOUBLE, MPI_SUM, world);
  if (all.known == 0.0 && all.points > 0.0 && comm->me == 0 &&
      fabs(all.atoms - all.points) > MASS_DIFFERENCE * std::max(all.atoms, all.points))
    error->warning(
        FLERR,
        "Fix mpm/handshake {}: in the zone, atoms have the mass {:.4g} per volume of the "
        "material points, and these {:.4g}: both must fill the zone with the density "
        "of the crystal",
        id, all.atoms / all.volume, all.points / all.volume);
}

void FixMPMHandshake::check_weights()
{
  // atoms must go as far beyond each zone as forces reach, and be moved by fix nve

  bigint n[2] = {0, 0}, all[2];
  std::vector<double> mine(zones.size(), -1.0e300), pads(zones.size());
  for (int i = 0; i < atom->nlocal; i++) {
    if (role[i] != COUPLED) continue;
    n[0]++;
    int integrators = 0;
    for (auto *ifix : modify->get_fix_list())
      if (ifix->time_integrate && (atom->mask[i] & ifix->groupbit) &&
          utils::strmatch(ifix->style, "^nve$"))
        integrators++;
    if (integrators != 1) n[1]++;
    for (std::size_t k = 0; k < zones.size(); k++) {
      const auto &zone = zones[k];
      const double sign = zone.zero > zone.one ? 1.0 : -1.0;
      mine[k] = MAX(mine[k], sign * (atom->x[i][zone.axis] - zone.zero));
    }
  }
  MPI_Allreduce(n, all, 2, MPI_LMP_BIGINT, MPI_SUM, world);
  MPI_Allreduce(mine.data(), pads.data(), (int) zones.size(), MPI_DOUBLE, MPI_MAX, world);
  if (all[0] == 0)
    error->all(FLERR, Error::NOLASTLINE,
               "Fix mpm/handshake {}: no atom of its group is in the zone", id);
  if (all[1])
    error->all(FLERR, Error::NOLASTLINE,
               "Fix mpm/handshake {}: {} atoms in reach of the zone are not moved by one fix nve",
               id, all[1]);
  const double need = force->pair->cutforce;
  for (std::size_t k = 0; k < zones.size(); k++)
    if (pads[k] < 0.5 * need)
      error->all(
          FLERR, Error::NOLASTLINE,
          "Fix mpm/handshake {}: atoms end {:.6g} beyond the plane {} of zone {}, where their "
          "weight is zero: create them up to {:.6g} beyond it, as far as forces reach",
          id, pads[k], zones[k].zero, k + 1, need);
}

void FixMPMHandshake::setup_pre_neighbor()
{
  weigh();
  check_weights();
}

void FixMPMHandshake::post_neighbor()
{
  comm->forward_comm(this);    // weights of ghosts
}

/** Blocks that atoms reach before the next update: by then they move half a skin. */
void FixMPMHandshake::extend_topology(MPMField &which)
{
  if (&which != field) return;
  Grid &grid = field->grid;
  const double drift = MIN(1.0, 0.5 * neighbor->skin / grid.lattice.h);
  for (int i = 0; i < atom->nlocal; i++)
    if (role[i] == COUPLED)
      blocks_around(*field, atom->x[i], drift, 0, [&](const int *b) {
        grid.activate(b);
      });
}

/** Forces by the gradient of the weight, as soon as those of the pair style are there: EAM knows
 *  the slopes of embedding energies for the present positions only. */
void FixMPMHandshake::setup(int /*vflag*/)
{
  check_embedding();
  find_pushes();
}

void FixMPMHandshake::post_force(int /*vflag*/)
{
  find_pushes();
  // second half of the way; v is that of its middle
  energy.lost += work_of_pushes(update->dt, 0.0);
}

void FixMPMHandshake::find_pushes()
{
  Pair *const pair = force->pair;
  double *const *const x = atom->x;
  const int *const type = atom->type;
  natoms = 0;
  pushes.clear();
  for (int i = 0; i < atom->nlocal; i++) {
    if (role[i] != COUPLED) continue;
    const int *const neighbors = list->firstneigh[i];
    const double share = eam.flaw > 0.0 ? eam.share(i, type[i]) : 0.0;
    double g[3] = {0.0, 0.0, 0.0};
    for (int jj = 0; jj < list->numneigh[i]; jj++) {
      const int j = neighbors[jj] & NEIGHMASK;
      if (role[j] == POINT || role[j] == NEAR_POINT)
        error->one(FLERR,
                   "Fix mpm/handshake {}: atom {} in reach of the zone is a neighbor of material "
                   "point {}, which stands for the same material: use neigh_modify exclude",
                   id, atom->tag[i], atom->tag[j]);
      const double difference = (role[j] == COUPLED ? weight[j] : 1.0) - weight[i];
      if (difference == 0.0) continue;
      double r[3];
      MathExtra::sub3(x[i], x[j], r);
      const double rsq = MathExtra::lensq3(r);
      if (rsq >= pair->cutsq[type[i]][type[j]]) continue;
      double f_over_r;
      pair->single(i, j, type[i], type[j], rsq, 1.0, 1.0, f_over_r);
      if (eam.flaw > 0.0 && rsq < eam.pair->cutsq[type[i]][type[j]]) f_over_r -= share / rsq;
      for (int d = 0; d < 3; d++) g[d] += 0.5 * difference * f_over_r * r[d];
    }
    natoms++;
    pushes.insert(pushes.end(), g, g + 3);
  }
}

/** Work of the pushes over half a step with the velocity v + ahead f/m. */
double FixMPMHandshake::work_of_pushes(double dt, double ahead) const
{
  double work = 0.0;
  const double *g = pushes.data();
  for (int i = 0; i < atom->nlocal; i++) {
    if (role[i] != COUPLED) continue;
    const double a = ahead * force->ftm2v / atom->rmass[i];
    for (int d = 0; d < 3; d++) work += g[d] * (atom->v[i][d] + a * atom->f[i][d]);
    g += 3;
  }
  return 0.5 * dt * work;
}

/** Weighted kinetic energy of the coupled atoms. */
double FixMPMHandshake::kinetic_energy() const
{
  double sum = 0.0;
  for (std::size_t k = 0; k < natoms; k++) {
    const int i = members[k];
    sum += weight[i] * atom->rmass[i] * MathExtra::lensq3(atom->v[i]);
  }
  return 0.5 * force->mvv2e * sum;
}

/** After the momentum equation of the points. */
void FixMPMHandshake::act(double dt, Stage stage)
{
  if (stage != STEP) return;
  find_nodes();
  map_members(dt);
  field->nodes.sum(reach.sums.data(), NREAL, 0, NREAL);
  energy.lost += kinetic_energy();
  if (damping > 0.0) damp(dt);
  tie(dt);
  move_atoms(dt);
  energy.lost += work_of_pushes(dt, 0.5 * dt) - kinetic_energy();
}

template <class Function> void FixMPMHandshake::Reach::each_node(std::size_t k, const Function &f)
{
  const int *const node = &nodes[k * n];
  const double *const share = &shares[k * n];
  for (int j = 0; j < n; j++) f(&sums[(std::size_t) node[j] * NREAL], share[j]);
}

/** Which nodes do atoms and points reach, and with which weights? */
void FixMPMHandshake::find_nodes()
{
  const auto &lattice = field->lattice;
  const int n = stencil_order(field->options.shape) + 1;
  reach.n = lattice.dim == 3 ? n * n * n : n * n;

  members.clear();
  for (int i = 0; i < atom->nlocal; i++)
    if (role[i] == COUPLED) members.push_back(i);
  if (members.size() != natoms)
    error->one(FLERR, "Fix mpm/handshake {}: atoms have changed since their forces were found", id);
  for (int i = 0; i < atom->nlocal; i++)
    if (role[i] == NEAR_POINT) members.push_back(i);
  reach.nodes.resize(members.size() * reach.n);
  reach.shares.resize(members.size() * reach.n);

  MPMStencil stencil(*field);
  std::size_t m = 0;
  for (const int i : members) {
    const double *const x = atom->x[i];
    for (int d = 0; d < lattice.dim; d++)
      if (!(fabs((x[d] - lattice.origin[d]) / lattice.h) < 4.0e6))
        error->one(FLERR, "Fix mpm/handshake {}: atom {} is far out of reach of the lattice", id,
                   atom->tag[i]);
    if (!stencil.visit_around(x, [&](int64_t node, double share, const double *) {
          reach.nodes[m] = (int) node;
          reach.shares[m++] = share;
        }))
      error->one(FLERR, "Fix mpm/handshake {}: atom {} has left the active blocks", id,
                 atom->tag[i]);
  }
}

/** Masses and momenta of atoms and points at the start of the step; force of the weighted energy of
 *  the atoms. */
void FixMPMHandshake::map_members(double dt)
{
  const double half = 0.5 * dt * force->ftm2v;
  reach.sums.assign(field->grid.nnodes() * NREAL, 0.0);
  for (std::size_t k = 0; k < members.size(); k++) {
    const int i = members[k];
    const bool is_atom = k < natoms;
    const double full = is_atom ? atom->rmass[i] : atom->rmass[i] / weight[i];
    const double weighted = is_atom ? weight[i] * full : 0.0;
    const double present = is_atom ? weight[i] > 0.0 : weight[i] < 1.0;
    double p[3];
    for (int d = 0; d < 3; d++)
      p[d] = full * atom->v[i][d] - (is_atom ? half * atom->f[i][d] : 0.0);
    const int lane = is_atom ? ATOMS : POINTS;
    reach.each_node(k, [&](double *s, double share) {
      for (int d = 0; d < 3; d++) s[lane + d] += share * p[d];
      s[lane + 3] += share * full;
      s[MASS] += share * weighted;
      s[PRESENCE] += share * present;
    });
  }
  for (std::size_t k = 0; k < natoms; k++) {
    const double w = weight[members[k]], *const f = atom->f[members[k]], *const g = &pushes[3 * k];
    const bool pushed = g[0] != 0.0 || g[1] != 0.0 || g[2] != 0.0;
    reach.each_node(k, [&](double *s, double share) {
      for (int d = 0; d < 3; d++) {
        s[FORCE + d] += share * (w * f[d] + g[d]);
        s[PLAIN + d] += share * w * f[d];
      }
      s[PRESENCE] += share * pushed;
    });
  }
}

/** Damp the motion of the atoms relative to the nodes, which get the momentum. */
void FixMPMHandshake::damp(double dt)
{
  const std::size_t nnodes = field->grid.nnodes();
  const double half = 0.5 * dt * force->ftm2v;
  field->grid.copy_aliases(reach.sums.data(), NREAL);
  std::vector<double> taken(nnodes * 4, 0.0);
  for (std::size_t k = 0; k < natoms; k++) {
    const int i = members[k];
    const double w = weight[i], m = atom->rmass[i];
    if (w == 0.0 || w == 1.0) continue;
    double coarse[3] = {0.0, 0.0, 0.0}, p[3];
    reach.each_node(k, [&](const double *s, double share) {
      for (int d = 0; d < 3; d++) coarse[d] += share * s[ATOMS + d] / s[ATOMS + 3];
    });
    const double part = -expm1(-damping * (1.0 - w) * dt);
    for (int d = 0; d < 3; d++) {
      const double v = atom->v[i][d] - half / m * atom->f[i][d], dv = part * (coarse[d] - v);
      energy.heat -= force->mvv2e * w * m * dv * (atom->v[i][d] + 0.5 * dv);
      atom->v[i][d] += dv;
      p[d] = w * m * dv;
    }
    for (std::size_t j = k * reach.n; j < (k + 1) * reach.n; j++)
      for (int d = 0; d < 3; d++)
        taken[4 * (std::size_t) reach.nodes[j] + d] += reach.shares[j] * p[d];
  }
  field->nodes.sum(taken.data(), 4, 0, 3);
  const double inverse = 1.0 / (dt * force->ftm2v);
  for (std::size_t n = 0; n < nnodes; n++)
    for (int d = 0; d < 3; d++) reach.sums[NREAL * n + FORCE + d] -= inverse * taken[4 * n + d];
}

/** Momentum with full masses of the velocity with which points move, [node][4]. */
std::vector<double> FixMPMHandshake::smooth_points()
{
  field->grid.copy_aliases(reach.sums.data(), NREAL);
  std::vector<double> p(4 * field->grid.nnodes(), 0.0);
  for (std::size_t k = natoms; k < members.size(); k++) {
    const double m = atom->rmass[members[k]] / weight[members[k]];
    double v[3] = {0.0, 0.0, 0.0};
    reach.each_node(k, [&](const double *s, double share) {
      for (int d = 0; d < 3; d++) v[d] += share * s[POINTS + d] / s[POINTS + 3];
    });
    for (std::size_t j = k * reach.n; j < (k + 1) * reach.n; j++)
      for (int d = 0; d < 3; d++)
        p[4 * (std::size_t) reach.nodes[j] + d] += reach.shares[j] * m * v[d];
  }
  field->nodes.sum(p.data(), 4, 0, 3);
  return p;
}

/** One velocity for atoms and points at each node. */
void FixMPMHandshake::tie(double dt)
{
  Grid &grid = field->grid;
  const double dtf = dt * force->ftm2v;
  const std::vector<double> smooth = smooth_points();
  double work = 0.0, impulse[3] = {0.0, 0.0, 0.0};
  for (std::size_t slot = 0; slot < grid.blocks.size(); slot++) {
    const auto &block = grid.blocks[slot];
    for (int n = 0; n < NODES_PER_BLOCK; n++) {
      if (block.alias >> n & 1) continue;
      double *const r = grid.record((int) slot, n);    // vx vy vz m, old velocity
      double *const s = &reach.sums[(slot * NODES_PER_BLOCK + n) * NREAL];
      const double ma = s[MASS], mc = r[3], inverse = 1.0 / (ma + mc);
      const bool tied = s[PRESENCE] > 0.0 && ma + mc > 0.0, owned = block.owned >> n & 1;
      if (!tied) {
        for (int d = 0; d < 3; d++) {
          s[CHANGE + d] = 0.0;
          s[VELOCITY + d] = r[d];
        }
        continue;
      }
      const double *const c = &smooth[4 * (slot * NODES_PER_BLOCK + n)];
      const bool both = ma > 0.0 && mc > 0.0;
      double change[3] = {0.0, 0.0, 0.0};
      for (int d = 0; d < 3; d++) {
        const double own = mc > 0.0 ? r[d] - r[4 + d] : 0.0;
        const double gain = inverse * (mc * own + dtf * s[FORCE + d]);
        const double ahead = both ? s[ATOMS + d] / s[ATOMS + 3] - c[d] / s[POINTS + 3] : 0.0;
        s[CHANGE + d] = ma > 0.0 ? gain - mc * inverse * ahead - dtf * s[PLAIN + d] / ma : 0.0;
        r[d] = r[4 + d] + gain + ma * inverse * ahead;
        s[VELOCITY + d] = r[d];
        if (!owned || mc == 0.0) continue;
        change[d] = r[d] - r[4 + d] - own;    // by atoms
        impulse[d] += mc * change[d];
        work += mc * change[d] * 0.5 * (r[d] + r[4 + d]);    // like a force
      }
      if (owned && field->ledger.on) field->ledger.note_push(r, change);
    }
  }
  field->ledger.contact += force->mvv2e * work;
  field->ledger.driven += force->mvv2e * work;
  energy.lost -= force->mvv2e * work;
  for (int d = 0; d < 3; d++) force_on_points[d] = dtf > 0.0 ? impulse[d] / dtf : 0.0;
}

/** Atoms: the change of the velocity of the nodes, or where they have no weight, this velocity. */
void FixMPMHandshake::move_atoms(double dt)
{
  field->grid.copy_aliases(reach.sums.data(), NREAL);
  const double half = 0.5 * dt * force->ftm2v;
  for (std::size_t k = 0; k < natoms; k++) {
    const int i = members[k];
    double *const v = atom->v[i], sum[3] = {0.0, 0.0, 0.0};
    const int lane = weight[i] == 0.0 ? VELOCITY : CHANGE;
    reach.each_node(k, [&](const double *s, double share) {
      for (int d = 0; d < 3; d++) sum[d] += share * s[lane + d];
    });
    for (int d = 0; d < 3; d++)
      v[d] = lane == CHANGE ? v[d] + sum[d]
                            : sum[d] - half / atom->rmass[i] * atom->f[i][d];    // that of fix nve
  }
}

/** Output: energy of the fine motion that damping took; force of the atoms on the points, and
 *  energy that atoms and points have lost where their velocities are tied, so that
 *
 *    weighted energy of the atoms + energy of the points + scalar + 4th value
 *
 *  changes only by what the integrators of both leave. */
double FixMPMHandshake::compute_scalar()
{
  double all;
  MPI_Allreduce(&energy.heat, &all, 1, MPI_DOUBLE, MPI_SUM, world);
  return all;
}

double FixMPMHandshake::compute_vector(int d)
{
  const double mine = d < 3 ? force_on_points[d] : energy.lost - energy.heat;
  double all;
  MPI_Allreduce(&mine, &all, 1, MPI_DOUBLE, MPI_SUM, world);
  return all;
}

double FixMPMHandshake::memory_usage()
{
  return FixMPMState::memory_usage() +
      sizeof(double) *
      (double) (reach.sums.capacity() + reach.shares.capacity() + pushes.capacity()) +
      sizeof(int) * (double) (reach.nodes.capacity() + members.capacity());
}

void FixMPMHandshake::grow_arrays(int nmax)
{
  FixMPMState::grow_arrays(nmax);
  vector_atom = weight;
}

int FixMPMHandshake::pack_forward_comm(int n, int *send, double *buf, int /*pbc_flag*/,
                                       int * /*pbc*/)
{
  for (int k = 0; k < n; k++) {
    buf[2 * k] = weight[send[k]];
    buf[2 * k + 1] = role[send[k]];
  }
  return 2 * n;
}

void FixMPMHandshake::unpack_forward_comm(int n, int first, double *buf)
{
  for (int k = 0; k < n; k++) {
    weight[first + k] = buf[2 * k];
    role[first + k] = buf[2 * k + 1];
  }
}

void FixMPMHandshake::write_restart(FILE *fp)
{
  keep_totals(world, &energy.heat, 1);
  keep_totals(world, &energy.lost, 1);
  if (comm->me) return;
  write_state(fp, &energy, sizeof(energy));
}

void FixMPMHandshake::restart(char *buf)
{
  const char *const state = read_state(lmp, id, buf, sizeof(energy));
  if (comm->me == 0) memcpy(&energy, state, sizeof(energy));
}
