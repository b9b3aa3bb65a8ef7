/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

// Pair style mpm/sheet with faces yes: atoms that touch the triangles of surfaces, and in 2d their
// lines.

#include "elements/pair_mpm_sheet.h"

#include "atom.h"
#include "base/mpm_lists.h"
#include "comm.h"
#include "domain.h"
#include "elements/fix_mpm_elements.h"
#include "error.h"
#include "math_extra.h"
#include "neighbor.h"
#include "update.h"

#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;
using namespace MPM_NS;

/** Faces of a body in the order of their lowest nodes, and room for ghosts that all nodes of a face
 *  need. */
void PairMPMSheet::find_faces_of(Body &body) const
{
  for (const auto &face : body.elements->all_faces()) {
    const auto &n = face.node;
    body.faces.push_back({*std::min_element(n, n + domain->dimension),
                          {n[0], n[1], n[2]},
                          2 * (int64_t) face.element + face.part});
  }
  std::sort(body.faces.begin(), body.faces.end(), [](const Face &a, const Face &b) {
    return a.low != b.low ? a.low < b.low : a.number < b.number;
  });
  if (body.faces.empty()) return;    // lines in 3d
  body.first.assign(body.elements->number_of_nodes() + 1, 0);
  for (const auto &face : body.faces) body.first[face.low + 1]++;
  for (std::size_t i = 1; i < body.first.size(); i++) body.first[i] += body.first[i - 1];
  body.elements->will_be_reached_from(distance + neighbor->skin);
}

/** All faces of which this rank has the nodes, each image once. Returns the length of the longest
 *  edge of all ranks. */
double PairMPMSheet::see_faces()
{
  const int dim = domain->dimension;
  double **const x = atom->x;
  const auto square_of = [&](int i, int j) {
    double edge[3];
    MathExtra::sub3(x[i], x[j], edge);
    return MathExtra::lensq3(edge);
  };
  double mine = 0.0, longest;
  for (const auto &body : bodies)
    for (const auto &face : body.elements->faces())
      for (int m = 1; m < dim; m++)
        for (int k = 0; k < m; k++) mine = std::max(mine, square_of(face.node[k], face.node[m]));
  MPI_Allreduce(&mine, &longest, 1, MPI_DOUBLE, MPI_MAX, world);

  seen.clear();
  const double limit = 1.000001 * longest;    // what is longer goes to another image
  for (int i = 0; i < atom->nlocal + atom->nghost; i++) {
    const int b = body_of(i);
    if (b == NO_BODY || bodies[b].faces.empty()) continue;
    const auto &body = bodies[b];
    const auto node = (int64_t) (atom->tag[i] - body.low);
    for (std::size_t f = body.first[node]; f < body.first[node + 1]; f++) {
      SeenFace face = {b, {}, (bigint) body.faces[f].number};
      bool all = true;
      for (int m = 0; m < dim && all; m++) {
        const int64_t other = body.faces[f].node[m];
        const int k = other == node ? i : atom->map((tagint) (other + body.low));
        all = k >= 0;
        if (all) face.node[m] = k == i ? i : domain->closest_image(i, k);
      }
      for (int m = 1; m < dim && all; m++)
        for (int k = 0; k < m; k++) all = all && square_of(face.node[k], face.node[m]) <= limit;
      if (all) seen.push_back(face);
    }
  }
  return sqrt(longest);
}

/** Once per neighbor list: atoms of this rank and faces that may touch before the next one. An atom
 *  keeps the side of a face that it had in the step before, also when it has come from another
 *  rank, as it may have gone through in this one. */
void PairMPMSheet::find_faces()
{
  const double longest = see_faces(), range = distance + neighbor->skin;
  const double needed = longest + range, cutoff = comm->get_comm_cutoff();
  if (cutoff < needed &&
      (comm->nprocs > 1 || domain->xperiodic || domain->yperiodic ||
       (domain->zperiodic && domain->dimension == 3)))
    error->all(FLERR, Error::NOLASTLINE,
               "Pair style mpm/sheet with faces yes: the longest edge of a surface is {:.6g} at "
               "step {}, which needs a comm_modify cutoff of {:.6g}, above the present {:.6g}",
               longest, update->ntimestep, needed, cutoff);

  // what was known, of atoms that are here now
  std::vector<Passages::Sight> known, gone;
  for (const auto &a : approaches) {
    const int i = atom->map((tagint) a.sight.node);
    (i >= 0 && i < atom->nlocal ? known : gone).push_back(a.sight);
  }
  if (comm->nprocs > 1)
    for (const auto &sight : gather_on_all(gone, world)) {
      const int i = atom->map((tagint) sight.node);
      if (i >= 0 && i < atom->nlocal) known.push_back(sight);
    }
  std::sort(known.begin(), known.end());
  const auto on_wrong_side = [&]() -> const Passages::Sight * {
    const auto found = std::find_if(known.begin(), known.end(), [](const Passages::Sight &sight) {
      return sight.within;
    });
    return found == known.end() ? nullptr : &*found;
  };
  if (!warned_through)
    warned_through = tell_first(on_wrong_side(),
                                "has come to the other side of element {} of fix mpm/elements {} "
                                "before step {}, and is pushed back: use a larger stiffness");

  approaches.clear();
  const int dim = domain->dimension;
  for_atoms_near(seen, atom->nlocal, range, [&](int i, int f, const double *const at[3]) {
    FacePlace place;
    place.find_plane(dim, at, atom->x[i]);
    if (!(std::fabs(place.height) <= range) || !touches(i, seen[f])) return;
    if (!place.within) place.find_rim(dim, at, atom->x[i]);
    if (place.distance > range) return;
    approaches.push_back({i,
                          f,
                          {(int64_t) atom->tag[i], seen[f].body, (int64_t) seen[f].number,
                           place.height >= 0.0 ? 1 : -1, 0}});
  });
  std::sort(approaches.begin(), approaches.end());
  for (auto &a : approaches) {
    const auto before = std::lower_bound(known.begin(), known.end(), a.sight);
    if (before == known.end() || a.sight < *before) continue;
    a.sight.side = before->side;
    before->within = 0;
  }

  // what is still on the wrong side is so far away that it is not held any more
  if (!warned_lost)
    warned_lost = tell_first(
        on_wrong_side(),
        "has been pushed through element {} of fix mpm/elements {}, seen at step {}, so far that "
        "it stays on the wrong side: use a larger stiffness");
}

/** Contacts of atoms of this rank. Where an atom is next to a face, and not above or below it, the
 *  side of this one is that on which it is. It is kept above and below, and on all faces as long as
 *  the atom has gone through one of them. */
void PairMPMSheet::for_face_contacts(const std::function<void(const FaceContact &)> &visit)
{
  double **const x = atom->x;
  const int dim = domain->dimension;
  std::vector<FacePlace> places;
  std::vector<ContactFace> touched;
  std::vector<ContactPart> parts;

  for (std::size_t begin = 0, end; begin < approaches.size(); begin = end) {
    const int i = approaches[begin].atom;
    end = begin;
    places.clear();
    bool through = false;
    for (; end < approaches.size() && approaches[end].atom == i; end++) {
      auto &a = approaches[end];
      const double *at[3];
      for (int m = 0; m < dim; m++) at[m] = x[seen[a.face].node[m]];
      places.emplace_back();
      places.back().find_plane(dim, at, x[i]);
      a.sight.within = places.back().within && (places.back().height >= 0.0) != (a.sight.side > 0);
      through = through || a.sight.within;
    }

    touched.clear();
    for (std::size_t k = begin; k < end; k++) {
      auto &a = approaches[k];
      auto &place = places[k - begin];
      if (!through) a.sight.side = place.height >= 0.0 ? 1 : -1;
      if (std::fabs(place.height) >= distance && !a.sight.within) continue;
      const auto &face = seen[a.face];
      if (!place.within) {
        const double *at[3];
        for (int m = 0; m < dim; m++) at[m] = x[face.node[m]];
        place.find_rim(dim, at, x[i]);
        if (place.distance >= distance) continue;
      }
      const Coeff &coeff = coeff_of(atom->type[i], atom->type[face.node[0]]);
      FaceContact c = {i, dim, {}, {}, {}, 0.0, 1.0, coeff.stiffness, coeff.damping};
      touched.push_back({{}, c.stiffness, c.damping});
      for (int m = 0; m < dim; m++) {
        c.node[m] = touched.back().node[m] = face.node[m];
        c.weight[m] = place.weight[m];
      }
      c.gap = a.sight.within ? -place.distance : place.distance;
      if (place.within || place.distance == 0.0)
        MathExtra::scale3(a.sight.side, place.normal, c.n);
      else
        MathExtra::scale3(1.0 / place.distance, place.from, c.n);
      visit(c);
    }

    find_common_parts(dim, touched, parts);
    for (const auto &part : parts) {
      const int a = part.node[0], b = part.node[1];
      const double s = a == b ? 0.0 : place_on_line(x[a], x[b], x[i]);
      FaceContact c = {i,   a == b ? 1 : 2, {a, b, 0},      {1.0 - s, s, 0.0}, {},
                       0.0, part.share,     part.stiffness, part.damping};
      for (int d = 0; d < 3; d++) c.n[d] = x[i][d] - c.weight[0] * x[a][d] - s * x[b][d];
      c.gap = MathExtra::len3(c.n);
      if (c.gap >= distance || c.gap == 0.0) continue;
      MathExtra::scale3(1.0 / c.gap, c.n);
      visit(c);
    }
  }
}

/** Forces on atoms and on the nodes of what they touch, whose sum and moment are zero. */
void PairMPMSheet::touch_faces(int eflag)
{
  double **const v = atom->v, **const f = atom->f;
  const int nlocal = atom->nlocal;
  for_face_contacts([&](const FaceContact &c) {
    const double overlap = distance - c.gap, elastic = c.stiffness * overlap;
    double normal = elastic, u[3];
    if (c.damping != 0.0) {
      MathExtra::copy3(v[c.atom], u);
      for (int m = 0; m < c.nnode; m++)
        for (int d = 0; d < 3; d++) u[d] -= c.weight[m] * v[c.node[m]][d];
      const double un = MathExtra::dot3(u, c.n), sum = elastic - c.damping * un;
      normal = c.stiffness > 0.0 ? std::max(0.0, sum) : std::min(0.0, sum);
      pvector[1] += (elastic - normal) * un;
    }
    pvector[0] += c.share;
    for (int m = 0; m < c.nnode; m++) {
      const double force = c.weight[m] * normal;
      double way[3];
      for (int d = 0; d < 3; d++) {
        f[c.atom][d] += force * c.n[d];
        f[c.node[m]][d] -= force * c.n[d];
      }
      if (!evflag) continue;
      MathExtra::sub3(atom->x[c.atom], atom->x[c.node[m]], way);
      ev_tally_xyz(c.atom, c.node[m], nlocal, 1,
                   eflag ? 0.5 * c.weight[m] * elastic * overlap : 0.0, 0.0, force * c.n[0],
                   force * c.n[1], force * c.n[2], way[0], way[1], way[2]);
    }
  });
}
