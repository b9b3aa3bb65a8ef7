/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_NODE_SCALAR_H
#define LMP_MPM_NODE_SCALAR_H

#include "field/mpm_point_map.h"
#include "material/batch_kernels.h"
#include "transfer/scalar.h"

#include <array>
#include <functional>
#include <initializer_list>
#include <vector>

namespace LAMMPS_NS {
class MPMField;

/** Scalar that spreads between the points of a field through the nodes: temperature, or the
 *  pressure of pore water. With the capacities C_p of points (the amount per unit of the scalar),
 *
 *      C_i = sum_p C_p N_ip,  u_i = sum_p C_p N_ip [u_p + g_p . (x_i - x_p)]/C_i,
 *      C_i du_i/dt = sum_p q_p . grad N_ip + sum_p s_p N_ip,
 *
 *  where q_p = V_p (flow per area) is the flux times the volume, and s_p is the rate of sources in
 *  points. Both may depend on the scalar and its gradient at the point. As the weights N_ip of a
 *  point have the sum one, and the sum of N_ip (x_i - x_p) is zero, sum_i C_i u_i is the amount
 *  that the points have, and fluxes do not change it.
 *
 *  Functions of the user are called with batches of points of a run. */
class MPMNodeScalar {
 public:
  static constexpr int MORE = 8;    ///< rows that kernels may read beyond the end

  /** Data of the points [first,first+n) of a run: in these rows, or where the user sets at. */
  struct Points {
    double row[MPM_NS::BATCH][4];    ///< [n][4] gradient g_p x y z, if there is one, and value
    double capacity[MPM_NS::BATCH];
    double volume[MPM_NS::BATCH];    ///< needed if volumes of nodes are wanted
    /** Place of gradients, values, and capacities: row and capacity, unless set. */
    MPM_NS::ScalarSource at;
  };
  /** [n][4] gradient x y z, or g_p in nodes_to_points(), and value at points. */
  using Rows = double (*)[4];
  /** Fills in the data of points. Returns false if this run takes no part until the next call of
   *  points_to_nodes(). */
  using Fill = std::function<bool(const MPMPointMap::Run &, int first, int n, Points &)>;
  /** In: gradient and value at points; out: q_p and s_p. */
  using Conduct = std::function<void(const MPMPointMap::Run &, int first, int n, Rows)>;
  /** In: gradient and value at points; out: factors k_p of the gradient, q_p = k_p grad u, without
   *  sources. */
  using Factors =
      std::function<void(const MPMPointMap::Run &, int first, int n, const Rows, double *factors)>;
  /** Receives new gradients g_p and values. before: values at points from the nodes before, or
   *  null. */
  using Take =
      std::function<void(const MPMPointMap::Run &, int first, int n, Rows, const double *before)>;
  /** Receives values alone, [n]. */
  using TakeValues =
      std::function<void(const MPMPointMap::Run &, int first, int n, const double *values)>;

  /** [node]. Nodes of this rank's points have the sums over ranks, which are the same on all ranks
   *  that share a node. Copies at periodic faces are not up to date. */
  std::vector<double> capacity, volume, value, before, rate;

  /** True if nodes of this field and of others exchange sums before ranks are summed
   *  (MPMHeatLevels): points_to_nodes(), find_rates(), and add_up() then leave the sums over this
   *  rank's points, until sum_nodes(), keep(), and sum_rates() are called. */
  bool is_level = false;

  explicit MPMNodeScalar(MPMField &field) : field(field) {}

  /** Start of a run. slopes: points have gradients g_p; volumes: volumes of nodes are wanted. */
  void init(bool slopes, bool volumes);
  /** Finds capacities, volumes, and values of nodes. keeps: also sets before = value. */
  void points_to_nodes(const Fill &, bool keeps);
  /** Sums values, capacities, and volumes over ranks, and divides values by capacities; called by
   *  the user with is_level. */
  void sum_nodes();
  void keep() { before = value; }
  /** Gives capacities C_p, or other values, of the points of a run that takes part in
   *  points_to_nodes(), [n]. */
  using GiveValues =
      std::function<void(const MPMPointMap::Run &, int first, int n, double *values)>;
  /** Extends u by terms of a series, as XPIC and FMPM do for velocities, see mpm_stages.cpp.
   *  u: in: values of nodes from points without slopes; out: this number of terms of the series for
   *  nodal values that would give the points their own values, u <- u + (value - S+ S u), where S
   *  maps nodes to points, and S+ maps back by capacities. sum_i C_i u_i does not change. */
  void add_terms(int terms, const GiveValues &capacities, std::vector<double> &u);
  /** Finds the rates of the values of nodes. more: adds the contributions that this rank knows to
   *  rates times capacity, before ranks are summed. */
  void find_rates(const Conduct &, const std::function<void()> &more = nullptr);
  /** The same for fluxes along gradients only, with less work. */
  void find_rates_along(const Factors &);
  /** Sums the rates over ranks and divides them by capacities; called by the user with is_level. */
  void sum_rates();
  /** Divides sums at nodes by the capacities. */
  void divide(std::vector<double> &sums) const
  {
    kernels.divide(sums.data(), capacity.data(), sums.size());
  }
  /** Bound of the eigenvalues of the negative rates on this rank, from the rows of their matrix
   *  [1/time]; not with domains. bound: out: V_p sum_e |k_de| for each axis d, with the tensor k of
   *  a linear flux. add_rows() stores the rows in rate, and greatest_row() is called after it; for
   *  a level, sums are exchanged in between. */
  void add_rows(const Conduct &bound);
  double greatest_row();
  /** Transfers values from nodes to points. changes: pass the values of before, too. */
  void nodes_to_points(const Take &, bool changes);
  void values_to_points(const TakeValues &);
  /** values_to_points() and add_up() in one pass. In: nodal values interpolated to points; out:
   *  contributions of points to the sums of add_up(). */
  void values_to_points_and_back(const GiveValues &, std::vector<double> &nodes);
  /** Interpolates gradients and values to points. */
  void gradients_to_points(const Conduct &);
  /** Finds sum_p q_p N_ip of values q_p of points, for runs that take part. */
  void add_up(const GiveValues &, std::vector<double> &nodes);

  double memory_usage() const;

 private:
  MPMField &field;
  MPM_NS::ScalarKernels kernels;
  bool slopes = false, volumes = false;
  bool moments = false;    // g_p is the fit of moving least squares
  std::vector<double> tiles[3];
  std::vector<double> first_term;    // first term in add_terms()
  std::vector<char> has_part;        // [runs]
  MPM_NS::ScalarStencil stencil;
  /** Ranges of base nodes in the tile of each active block. Stored here because other sums over
   *  points, of walls and contact, may come between the calls of a step. */
  std::vector<std::array<int, 6>> boxes;

  template <class F>
  void visit(const MPMPointMap::ActiveBlock &, MPM_NS::SlopeKind, int *box, const F &);
  template <class Use>
  void pass(MPM_NS::SlopeKind, std::initializer_list<std::vector<double> *> from,
            std::vector<double> *to, const Use &);
  void sum(std::vector<double> &nodes) const;
  int *box_of(const MPMPointMap::ActiveBlock &);
};

/** Activates the blocks around those blocks (their coordinates) that are wanted, or around all:
 *  ranks need the nodes around those that their points reach. */
void activate_blocks_around(MPMField &, const std::function<bool(const int *)> &wanted = nullptr);
/** Largest sum of (dN/dx)^2/N over the nodes of a point along an axis, x in node spacings. */
double steepest_function(const MPMField &);

/** Raises most to the greatest of itself and a[p]/b[p] of n points, b > 0. Does not divide where
 *  most is not exceeded. */
inline void raise_ratio(double &most, int n, const double *a, const double *b)
{
  int above = 0;
  for (int p = 0; p < n; p++) above += a[p] > most * b[p];
  for (int p = 0; above && p < n; p++)
    if (a[p] > most * b[p]) most = a[p] / b[p];
}

}    // namespace LAMMPS_NS
#endif
