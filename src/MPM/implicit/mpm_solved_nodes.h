/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_SOLVED_NODES_H
#define LMP_MPM_SOLVED_NODES_H

#include "field/mpm_field.h"
#include "field/mpm_node_system.h"
#include "solve/bytes_of.h"
#include "solve/lattice_nodes.h"

#include <cmath>
#include <cstdint>
#include <type_traits>
#include <vector>

namespace LAMMPS_NS {

/** The nodes of all fields that an implicit step solves for. Vectors are [node][dim], one field
 *  after the other, and zero at nodes without a mass. Each node counts once in sums, on the rank
 *  that owns it. */
class MPMSolvedNodes {
 public:
  /** A field and the range of its nodes in vectors. */
  struct Body {
    MPMField &field;
    int64_t first = 0;    ///< index of the first of its nodes

    int64_t end() const { return first + field.grid.nnodes(); }
    bool owns(int64_t n) const { return field.grid.owns(n - first); }
  };

  MPMSolvedNodes(class LAMMPS *, const std::vector<MPMField *> &);

  /** Start of a run. */
  void init() { by_reach = field.domains || !field.elements.empty(); }
  /** Start of a step: reads masses and velocities from the records of nodes. Collective. */
  void begin_step();
  /** Restores the records of nodes, which hold trial motions during the step, to the start of the
   *  step. */
  void restore_records();

  class LAMMPS *const lmp;
  MPMField &field;    ///< the first of them
  const int width;    ///< dim
  std::vector<Body> bodies;
  std::vector<double> mass;                 ///< [node]
  std::vector<double> start_velocity;       ///< before the momentum equation
  std::vector<double> explicit_velocity;    ///< after it
  std::vector<int64_t> active;              ///< nodes with a mass, owned ones first
  std::size_t nowned = 0;                   ///< number of owned ones among these
  std::vector<double *> active_records;     ///< their records

  int64_t nnodes() const { return (int64_t) mass.size(); }
  int64_t nreals() const { return nnodes() * width; }
  /** Spacing of the nodes of the first field. */
  double spacing() const { return field.lattice.h; }
  /** Do the points of the first field have domains? */
  bool has_domains() const { return (bool) field.domains; }
  /** Are there nodes without a mass that have a stiffness? */
  bool has_unreached() const { return by_reach; }
  /** Place of the first node of a field; -1: it is not one of these. */
  int64_t first_of(const MPMField &) const;
  /** Index in the lattice of a node of the first field, within the periodic box. */
  MPM_NS::LatticeIndex index_of(int64_t n) const;

  /** value[k] = a[k] . b[k] for n pairs of vectors. Collective. */
  void products(int n, const double *const *a, const double *const *b, double *value);
  double product(const double *a, const double *b);
  double norm(const double *a) { return std::sqrt(product(a, a)); }
  /** Sums of mine [n] over ranks, added in their order. Collective. */
  void sum_in_order(int n, const double *mine, double *all)
  {
    LAMMPS_NS::sum_in_order(lmp, n, mine, rank_sums, all);
  }
  /** Is this true on any rank? Collective. */
  bool any(bool mine) const;
  /** The largest value of all ranks. Collective. */
  double largest(double mine) const;
  /** Sum of the lengths of the vectors of the nodes that this rank owns. */
  double sum_of_lengths(const std::vector<double> &f) const;
  /** The same for forces that are to be in balance: those of domains are seen by the corners of
   *  these, see find_reach(). */
  double sum_of_residuals(const std::vector<double> &f) const;
  /** Root of the mean square of a motion, with the mass as weight. Collective. */
  double mean_size(const std::vector<double> &u) const;

  /** Calls use(body, n, record) for all nodes. */
  template <class Use> void each_record(const Use &use)
  {
    for (auto &body : bodies) {
      double *record = body.field.grid.nodes();
      const int64_t end = body.end();
      for (int64_t n = body.first; n < end; n++, record += 8) use(body, n, record);
    }
  }
  /** Calls use(n) for all nodes with a mass that this rank owns. */
  template <class Use> void each_owned(const Use &use) const
  {
    for (std::size_t k = 0; k < nowned; k++) use(active[k]);
  }
  /** Calls use(n, k) for all entries k of vectors that belong to nodes n with a mass. The width is
   *  a constant in the innermost loop. */
  template <class Use> void each_entry(const Use &use) const
  {
    const auto all = [&](auto dim) {
      constexpr int W = decltype(dim)::value;
      for (const int64_t n : active)
        for (int d = 0; d < W; d++) use(n, W * n + d);
    };
    if (width == 2)
      all(std::integral_constant<int, 2>());
    else
      all(std::integral_constant<int, 3>());
  }
  double memory_usage() const
  {
    return MPM_NS::bytes_of(active, active_records, mass, start_velocity, explicit_velocity, reach);
  }

 private:
  bool by_reach = false;        // are forces of nodes weighted by reach?
  std::vector<double> reach;    // [node] number of points there, at most 1
  std::vector<double> sums, rank_sums;

  void find_reach();
  void find_active();
};

}    // namespace LAMMPS_NS
#endif
