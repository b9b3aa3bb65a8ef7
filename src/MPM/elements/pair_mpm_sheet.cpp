/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "elements/pair_mpm_sheet.h"

#include "atom.h"
#include "base/mpm_lists.h"
#include "base/mpm_options.h"
#include "comm.h"
#include "domain.h"
#include "elements/fix_mpm_elements.h"
#include "error.h"
#include "force.h"
#include "math_extra.h"
#include "modify.h"
#include "neigh_list.h"
#include "neighbor.h"
#include "update.h"

#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;
using namespace MPM_NS;

// paths along a sheet that are shorter than this many distances: a fold whose layers touch has one
// of pi/2 distances around it
static constexpr double NEAR = 2.0;
// nodes that are so much closer than the distance may get to the other side
static constexpr double DEEP = 0.5;

void PairMPMSheet::compute(int eflag, int vflag)
{
  ev_init(eflag, vflag);
  if (neighbor->ago == 0) find_pairs();

  double **x = atom->x, **v = atom->v, **f = atom->f;
  const int *type = atom->type;
  const int nlocal = atom->nlocal, newton_pair = force->newton_pair;
  double contacts = 0.0, dissipated = 0.0;
  int deep = -1;

  for (const auto &[i, j] : pairs) {
    double n[3];
    MathExtra::sub3(x[i], x[j], n);
    const double rsq = MathExtra::lensq3(n);
    if (rsq >= distance * distance) continue;
    if (rsq == 0.0) {    // no direction to push to
      deep = i;
      continue;
    }
    const Coeff &c = coeff_of(type[i], type[j]);
    const double r = sqrt(rsq), overlap = distance - r, elastic = c.stiffness * overlap;
    if (r < DEEP * distance) deep = i;
    MathExtra::scale3(1.0 / r, n);
    double normal = elastic, power = 0.0;
    if (c.damping > 0.0) {
      double u[3];
      MathExtra::sub3(v[i], v[j], u);
      const double un = MathExtra::dot3(u, n);
      normal = std::max(0.0, elastic - c.damping * un);    // sheets do not pull on each other
      power = (elastic - normal) * un;
    }
    for (int k = 0; k < 3; k++) {
      f[i][k] += normal * n[k];
      if (newton_pair || j < nlocal) f[j][k] -= normal * n[k];
    }
    const double share = newton_pair || j < nlocal ? 1.0 : 0.5;
    contacts += share;
    dissipated += share * power;
    if (evflag)
      ev_tally(i, j, nlocal, newton_pair, eflag ? 0.5 * elastic * overlap : 0.0, 0.0, normal / r,
               r * n[0], r * n[1], r * n[2]);
  }

  if (deep >= 0 && !warned_deep) {
    warned_deep = true;
    error->warning(FLERR,
                   "Pair style mpm/sheet: node {} and what it touches are closer than half of the "
                   "distance {} at step {}: they may pass each other, use a larger stiffness",
                   atom->tag[deep], distance, update->ntimestep);
  }
  pvector[0] = contacts;
  pvector[1] = dissipated;
  if (faces) touch_faces(eflag);
  if (vflag_fdotr) virial_fdotr_compute();
}

/** Once per neighbor list: of its pairs those with a node of a sheet that are not near each other
 *  along it. */
void PairMPMSheet::find_pairs()
{
  pairs.clear();
  const auto touches_faces = [&](int body) {
    return faces && body != NO_BODY && !bodies[body].faces.empty();
  };
  for (int ii = 0; ii < list->inum; ii++) {
    const int i = list->ilist[ii], mine = body_of(i);
    for (int jj = 0; jj < list->numneigh[i]; jj++) {
      const int j = list->firstneigh[i][jj] & NEIGHMASK, other = body_of(j);
      if ((mine == NO_BODY && other == NO_BODY) || touches_faces(mine) || touches_faces(other) ||
          coeff_of(atom->type[i], atom->type[j]).stiffness == 0.0)
        continue;
      if (mine == other) {
        const auto &body = bodies[mine];
        if (body.nodes->near(atom->tag[i] - body.low, atom->tag[j] - body.low)) continue;
      }
      pairs.emplace_back(i, j);
    }
  }
  if (faces) find_faces();
  warn_about_step();
  if (starting) warn_about_start();
  if (!faces && !warned_gap) warn_about_gaps();
  if (!faces && !warned_through) warn_about_passages();
}

int PairMPMSheet::body_of(int i) const
{
  for (std::size_t k = 0; k < bodies.size(); k++)
    if (atom->mask[i] & bodies[k].elements->groupbit) return (int) k;
  return NO_BODY;
}

/** The bound of the elements does not know of contacts. A node between two others that hold still
 *  has a frequency of sqrt(2 k/m), and 2/omega is the limit. With faces it bears others as well, by
 *  twice as much. */
void PairMPMSheet::warn_about_step()
{
  if (warned_dt) return;
  double shortest = HUGE_VAL, all;
  for (int i = 0; i < atom->nlocal; i++) {
    if (body_of(i) == NO_BODY) continue;
    for (int t = 1; t <= atom->ntypes; t++) {
      const double k = coeff_of(atom->type[i], t).stiffness;
      const double parts = faces ? 1.0 : 2.0;
      if (k > 0.0) shortest = std::min(shortest, sqrt(parts * atom->rmass[i] / (k * force->ftm2v)));
    }
  }
  MPI_Allreduce(&shortest, &all, 1, MPI_DOUBLE, MPI_MIN, world);
  if (!(update->dt > all)) return;
  warned_dt = true;
  if (comm->me == 0)
    error->warning(FLERR,
                   "Pair style mpm/sheet: the time step {:.6g} is above the limit {:.6g} of a node "
                   "between two others: use a smaller stiffness or time step",
                   update->dt, all);
}

/** Layers that lie too close in the mesh jump apart. Those of a restart file have come as close as
 *  they are by forces. */
void PairMPMSheet::warn_about_start()
{
  constexpr double CLOSER = 1.0e-6;    // part of the distance, for round-off
  starting = false;
  double mine[2] = {0.0, 0.0}, sums[2], least = distance, closest;
  for (const auto &[i, j] : pairs) {
    double n[3];
    MathExtra::sub3(atom->x[i], atom->x[j], n);
    const double r = MathExtra::len3(n), overlap = distance - r;
    if (!(overlap > CLOSER * distance)) continue;
    const double share = force->newton_pair || j < atom->nlocal ? 1.0 : 0.5;
    mine[0] += share;
    mine[1] += 0.5 * share * coeff_of(atom->type[i], atom->type[j]).stiffness * overlap * overlap;
    least = std::min(least, r);
  }
  if (faces)
    for_face_contacts([&](const FaceContact &c) {
      if (!(distance - c.gap > CLOSER * distance)) return;
      mine[0] += c.share;
      mine[1] += 0.5 * c.stiffness * (distance - c.gap) * (distance - c.gap);
      least = std::min(least, c.gap);
    });
  MPI_Allreduce(mine, sums, 2, MPI_DOUBLE, MPI_SUM, world);
  MPI_Allreduce(&least, &closest, 1, MPI_DOUBLE, MPI_MIN, world);
  if (sums[0] == 0.0 || comm->me != 0) return;
  error->warning(
      FLERR,
      "Pair style mpm/sheet: {} pairs of nodes, or of a node and another atom or a face, are "
      "closer than the "
      "distance {} at the start, the closest by {:.4g}: they push each other away at once, with an "
      "energy of {:.6g}: use a smaller distance, which may need a finer mesh, or layers that are "
      "farther apart",
      (bigint) std::lround(sums[0]), distance, closest, sums[1]);
}

/** A node of another layer that is in a triangle keeps at most this distance from the corners of
 *  it, and feels nothing there if it is above that of the contact. */
void PairMPMSheet::warn_about_gaps()
{
  const bool touches = std::any_of(coeffs.begin(), coeffs.end(), [](const Coeff &c) {
    return c.stiffness > 0.0;
  });
  for (const auto &body : bodies) {
    const double gap = body.elements->widest_gap();
    if (!touches || gap < distance) continue;
    warned_gap = true;
    if (comm->me == 0)
      error->warning(
          FLERR,
          "Pair style mpm/sheet: fix mpm/elements {} has places that are {:.4g} from all nodes "
          "around them at step {}, not less than the distance {}, so that what touches it can "
          "pass between these: use a larger distance or a finer mesh",
          body.elements->id, gap, update->ntimestep, distance);
  }
}

/** Nodes repel each other, and one may still be pushed through the middle of a face. Each time that
 *  neighbor lists are made, which is before a node has moved by half of the skin, the side of a
 *  face on which nodes are next to it is compared with that of the time before. */
void PairMPMSheet::warn_about_passages()
{
  std::vector<Passages::FaceID> mine;
  auto now = look_at_faces(mine);
  if (comm->nprocs > 1) share_passages(mine);
  if (!tell_first(passages.look(std::move(now)),
                  "has gone through element {} of fix mpm/elements {}, seen at step {}, and may be "
                  "held on the wrong side from now on: use a larger stiffness or distance, or a "
                  "finer mesh, or the keyword faces"))
    return;
  warned_through = true;
  passages.forget();    // the next run begins with what it sees first
}

/** A warning of what the first of those ranks has found that have found something; null: nothing.
 *  Has one? On all ranks together. */
bool PairMPMSheet::tell_first(const Passages::Sight *found, const char *what) const
{
  int rank = found ? comm->me : comm->nprocs, first;
  MPI_Allreduce(&rank, &first, 1, MPI_INT, MPI_MIN, world);
  if (first == comm->nprocs) return false;
  Passages::Sight passage = {};
  if (comm->me == first) passage = *found;
  MPI_Bcast(&passage, sizeof(passage), MPI_BYTE, first, world);
  if (comm->me == 0)    // which has the log file
    error->warning(FLERR, "Pair style mpm/sheet: node {} {}", passage.node,
                   fmt::format(fmt::runtime(what), passage.face / 2,
                               bodies[passage.body].elements->id, update->ntimestep));
  return true;
}

/** What is known of faces that have gone to other ranks, which are few, goes to all of these. */
void PairMPMSheet::share_passages(std::vector<Passages::FaceID> &mine)
{
  std::sort(mine.begin(), mine.end());
  passages.add(gather_on_all(passages.take_others(mine), world));
}

/** Nodes that are next to faces of this rank, but not near these along the surface; mine: these
 *  faces. */
std::vector<Passages::Sight> PairMPMSheet::look_at_faces(std::vector<Passages::FaceID> &mine)
{
  // nodes that come to a face from next to it: nodes at edges and rims keep those that go around
  // them farther away
  constexpr double MARGIN = 0.1;
  std::vector<Passages::Sight> sights;
  const double range = distance + neighbor->skin;
  std::vector<SeenFace> owned;
  for (std::size_t b = 0; b < bodies.size(); b++)
    for (const auto &face : bodies[b].elements->faces()) {
      const auto &n = face.node;
      owned.push_back({(int) b, {n[0], n[1], n[2]}, 2 * face.element + face.part});
      mine.emplace_back((int64_t) b, owned.back().number);
    }
  for_atoms_near(
      owned, atom->nlocal + atom->nghost, range, [&](int i, int f, const double *const at[3]) {
        bool within;
        const int side = side_of_face(domain->dimension, at, atom->x[i], range, MARGIN, within);
        if (side != 0 && touches(i, owned[f]))
          sights.push_back({atom->tag[i], owned[f].body, owned[f].number, side, within});
      });
  return sights;
}

/** Does an atom touch a face: is there a coefficient, and is it not near along the surface? */
bool PairMPMSheet::touches(int i, const SeenFace &face)
{
  if (coeff_of(atom->type[i], atom->type[face.node[0]]).stiffness == 0.0) return false;
  const auto &body = bodies[face.body];
  if (!(atom->mask[i] & body.elements->groupbit)) return true;
  for (int m = 0; m < domain->dimension; m++)
    if (body.nodes->near(atom->tag[i] - body.low, atom->tag[face.node[m]] - body.low)) return false;
  return true;
}

/** Visit atoms, of the first ones, that may be closer to a face than range, with the face and the
 *  positions of its nodes. */
void PairMPMSheet::for_atoms_near(
    const std::vector<SeenFace> &list, int natoms, double range,
    const std::function<void(int i, int f, const double *const at[3])> &visit) const
{
  double **const x = atom->x;
  const int dim = domain->dimension;

  // atoms in cells of this size
  const auto cell_of = [&](double at) {
    return (int64_t) std::floor(at / range);
  };
  const auto key_of = [](int64_t i, int64_t j, int64_t k) {
    return (i * 2097152 + j) * 2097152 + k;
  };
  std::vector<std::pair<int64_t, int>> cells(natoms);
  for (int i = 0; i < natoms; i++)
    cells[i] = {key_of(cell_of(x[i][0]), cell_of(x[i][1]), cell_of(x[i][2])), i};
  std::sort(cells.begin(), cells.end());

  for (std::size_t f = 0; f < list.size(); f++) {
    const double *at[3];
    int64_t low[3], high[3];
    for (int m = 0; m < dim; m++) at[m] = x[list[f].node[m]];
    for (int d = 0; d < 3; d++) {
      double least = at[0][d], most = at[0][d];
      for (int m = 1; m < dim; m++) {
        least = std::min(least, at[m][d]);
        most = std::max(most, at[m][d]);
      }
      low[d] = cell_of(least - range);
      high[d] = cell_of(most + range);
    }
    for (int64_t i = low[0]; i <= high[0]; i++)
      for (int64_t j = low[1]; j <= high[1]; j++) {
        const auto first =
            std::lower_bound(cells.begin(), cells.end(), std::make_pair(key_of(i, j, low[2]), -1));
        for (auto c = first; c != cells.end() && c->first <= key_of(i, j, high[2]); ++c)
          visit(c->second, (int) f, at);
      }
  }
}

/** pair_style mpm/sheet D */
Options MPMSheetOptions::declare()
{
  using namespace option;
  Options o("pair_style mpm/sheet");
  o.argument(number(distance, "D", POSITIVE));
  o.add("faces", {yes_no(faces)},
        "whether nodes touch the triangles (2d: lines) of surfaces instead of their nodes");
  return o;
}

void PairMPMSheet::settings(int narg, char **arg)
{
  Options options = declare();
  read_options(lmp, options, narg, arg, 0);
}

/** pair_coeff I J k keyword values ... */
Options MPMSheetCoeff::declare()
{
  using namespace option;
  Options o("pair_coeff mpm/sheet");
  o.argument(number(stiffness, "k", NOT_NEGATIVE));
  o.add("damping",
        {number(damping, "c", NOT_NEGATIVE, "force/velocity",
                "damping force per velocity at which two nodes approach or separate")});
  return o;
}

void PairMPMSheet::init_style()
{
  find_bodies();
  const bool damped = std::any_of(coeffs.begin(), coeffs.end(), [](const Coeff &c) {
    return c.damping > 0.0;
  });
  if (damped && !comm->ghost_velocity)
    error->all(FLERR, Error::NOLASTLINE,
               "Pair style mpm/sheet with damping needs the velocities of ghost atoms: use "
               "comm_modify vel yes");
  warned_deep = warned_dt = warned_gap = warned_through = warned_lost = false;

  // atoms may have been displaced since the last run: only those that are on the wrong side keep
  // what they know
  approaches.erase(std::remove_if(approaches.begin(), approaches.end(),
                                  [](const Approach &a) {
                                    return !a.sight.within;
                                  }),
                   approaches.end());
  if (faces && !force->newton_pair)
    error->all(FLERR, Error::NOLASTLINE,
               "Pair style mpm/sheet with faces yes needs newton on for pairs, as nodes of a face "
               "can be on other ranks: use the newton command");
  if (modify->nfix_restart_peratom) starting = false;
  neighbor->add_request(this);
}

/** All ranks know which nodes are near each other, as any can be ghosts. */
void PairMPMSheet::find_bodies()
{
  const auto bodies_before = std::move(bodies);
  bodies.clear();
  for (auto *ifix : modify->get_fix_by_style("^mpm/elements$")) {
    auto *const elements = dynamic_cast<FixMPMElements *>(ifix);
    if (!elements->is_thin()) continue;
    if (const char *field = elements->field_of_nodes())
      error->all(FLERR, Error::NOLASTLINE,
                 "Pair style mpm/sheet: the nodes of fix mpm/elements {} belong to fix mpm {}, "
                 "whose lattice holds together what is closer than its cells: move them with fix "
                 "nve, or use fix mpm/contact",
                 elements->id, field);
    bodies.push_back({elements,
                      elements->first_node(),
                      std::make_unique<NearNodes>(elements->number_of_nodes(), elements->edges(),
                                                  NEAR * distance),
                      {},
                      {}});
    if (faces) find_faces_of(bodies.back());
  }
  if (bodies.empty())
    error->all(FLERR, Error::NOLASTLINE,
               "Pair style mpm/sheet needs a fix mpm/elements with thickness or section");
  if (!std::equal(bodies.begin(), bodies.end(), bodies_before.begin(), bodies_before.end(),
                  [](const Body &a, const Body &b) {
                    return a.elements == b.elements;
                  })) {
    passages.forget();    // which has their numbers
    approaches.clear();
  }
}

double PairMPMSheet::init_one(int i, int j)
{
  if (!coeff_of(i, j).set)
    error->all(FLERR, Error::NOLASTLINE,
               "Pair style mpm/sheet has no pair_coeff for types {} and {}: give one, with "
               "stiffness 0 if they shall not touch",
               i, j);
  return coeff_of(i, j).stiffness > 0.0 ? distance : 0.0;
}

void PairMPMSheet::write_restart_settings(FILE *fp)
{
  fwrite(&distance, sizeof(double), 1, fp);
  fwrite(&faces, sizeof(bool), 1, fp);
}

void PairMPMSheet::read_restart_settings(FILE *fp)
{
  if (comm->me == 0) {
    utils::sfread(FLERR, &distance, sizeof(double), 1, fp, nullptr, error);
    utils::sfread(FLERR, &faces, sizeof(bool), 1, fp, nullptr, error);
  }
  MPI_Bcast(&distance, 1, MPI_DOUBLE, 0, world);
  MPI_Bcast(&faces, sizeof(bool), MPI_BYTE, 0, world);
}

double PairMPMSheet::memory_usage()
{
  double bytes = MPMPair::memory_usage() + passages.memory() + bytes_of(seen, approaches);
  for (const auto &body : bodies) bytes += body.nodes->memory() + bytes_of(body.faces);
  return bytes;
}
