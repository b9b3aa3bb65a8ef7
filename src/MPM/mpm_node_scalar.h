/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_NODE_SCALAR_H
#define LMP_MPM_NODE_SCALAR_H

#include "material/batch.h"
#include "mpm_point_map.h"
#include "transfer/scalar.h"

#include <array>
#include <functional>
#include <vector>

namespace LAMMPS_NS {
class MPMField;

/** A scalar that spreads between the points of a field by way of the nodes: temperature, or the pressure of pore
 *  water. With the capacities C_p of points, what a unit of the scalar in a point takes,
 *
 *    C_i = sum_p C_p N_ip,  u_i = sum_p C_p N_ip [u_p + g_p . (x_i - x_p)]/C_i,
 *    C_i du_i/dt = sum_p q_p . grad N_ip + sum_p s_p N_ip,
 *
 *  with the flux times the volume, q_p = -V_p (flow per area), and the rate s_p of sources in points, both of which may
 *  depend on the scalar and its gradient there. As sums of weights are one and N_ip (x_i - x_p) have none, sum_i C_i
 *  u_i is what the points have, and fluxes do not change it.
 *
 *  Functions of the user are called with batches of points of a run. */
class MPMNodeScalar {
 public:
  static constexpr int MORE = 8;    ///< kernels may read a little more

  /** What the points [first,first+n) of a run have: in these rows, or where the user says. */
  struct Points {
    double row[MPM_NS::BATCH][4];    ///< [n][4] gradients g_p x y z, if there are any, and values
    double capacity[MPM_NS::BATCH];
    double volume[MPM_NS::BATCH];    ///< if volumes of nodes are wanted
    MPM_NS::ScalarSource
        at;    ///< of gradients, values, and capacities: row and capacity, unless set
  };
  /** What points get: [n][4] gradient x y z, or g_p in nodes_to_points(), and value. */
  using Rows = double (*)[4];
  /** false: this run has no part, until the next call of points_to_nodes(). */
  using Fill = std::function<bool(const MPMPointMap::Run &, int first, int n, Points &)>;
  /** In: gradient and value at points; out: q_p and s_p. */
  using Conduct = std::function<void(const MPMPointMap::Run &, int first, int n, Rows)>;
  /** In: gradient and value at points; out: factors k_p of the gradient, q_p = k_p grad u, without sources. */
  using Factors =
      std::function<void(const MPMPointMap::Run &, int first, int n, const Rows, double *factors)>;
  /** New slopes g_p and values; before: values at points by the nodes before, or null. */
  using Take =
      std::function<void(const MPMPointMap::Run &, int first, int n, Rows, const double *before)>;
  /** Values alone, [n]. */
  using TakeValues =
      std::function<void(const MPMPointMap::Run &, int first, int n, const double *values)>;

  /** Of each node. Those of this rank's points and sums over ranks are the same on all ranks that share a node;
   *  copies at periodic faces are not up to date. */
  std::vector<double> capacity, volume, value, before, rate;

  /** Nodes of this field and of others exchange sums before ranks are summed (MPMHeatLevels): points_to_nodes() and find_rates()
   *  leave them as what this rank's points gave, until sum_nodes(), keep(), and sum_rates() are called. */
  bool is_level = false;

  explicit MPMNodeScalar(MPMField &field) : field(field) {}

  /** Start of a run. slopes: points have gradients g_p; volumes: those of nodes are wanted. */
  void init(bool slopes, bool volumes);
  /** Capacities, volumes, and values of nodes; keeps: before = value. */
  void points_to_nodes(const Fill &, bool keeps);
  void sum_nodes();
  void keep() { before = value; }
  /** Capacities C_p of the points of a run that has a part, as in points_to_nodes(). */
  using GiveValues =
      std::function<void(const MPMPointMap::Run &, int first, int n, double *values)>;
  /** u: in: values of nodes that points without slopes gave; out: this many terms of the series for those that would give
   *  the points their values, u <- u + (value - S+ S u), with S from nodes to points and S+ back by capacities. sum_i C_i u_i
   *  stays what it is. As XPIC and FMPM do with velocities, see mpm_stage_series.cpp. */
  void add_terms(int terms, const GiveValues &capacities, std::vector<double> &u);
  /** Rates of the values of nodes. more: adds to their rates times capacity what this rank knows of, before ranks
   *  are summed. */
  void find_rates(const Conduct &, const std::function<void()> &more = nullptr);
  /** The same for fluxes along gradients alone, with less work. */
  void find_rates_along(const Factors &);
  void sum_rates();
  /** A bound of the eigenvalues of minus the rates, by the rows of their matrix [1/time], of this rank; not with domains.
   *  bound: out: V_p sum_e |k_de| for each axis d, with the tensor k of a linear flux. Both one after the other, or, for a
   *  level, with what is between. */
  void add_rows(const Conduct &bound);    // the rows stay in the place of rates
  double greatest_row();
  double greatest_rate(const Conduct &bound)
  {
    add_rows(bound);
    return greatest_row();
  }
  /** changes: give the values of before, too. */
  void nodes_to_points(const Take &, bool changes);
  void values_to_points(const TakeValues &);
  /** In: values of nodes at points; out: what points give to the sums over points of add_up(). */
  using Exchange = std::function<void(const MPMPointMap::Run &, int first, int n, double *values)>;
  /** values_to_points() and add_up() in one. */
  void values_to_points_and_back(const Exchange &, std::vector<double> &nodes);
  /** Gradients and values at points. */
  void gradients_to_points(const Conduct &);
  /** Sums sum_p q_p N_ip of numbers q_p that points give, of runs that have a part. */
  void add_up(const GiveValues &, std::vector<double> &nodes);

  double memory_usage() const;

 private:
  MPMField &field;
  MPM_NS::ScalarKernels kernels;
  bool slopes = false, volumes = false;
  bool moments = false;    // g_p is the fit of moving least squares
  std::vector<double> tiles[3];
  std::vector<double> first_term;    // of add_terms()
  std::vector<char> has_part;        // [runs]
  MPM_NS::ScalarStencil stencil;
  /** Of base nodes in the tile of each active block: other sums over points, of walls and contact, may come between the
   *  calls of a step. */
  std::vector<std::array<int, 6>> boxes;

  /** Rates by give(run, first, n, q), which adds what the points with these gradients and values give to a tile. */
  template <class F> void find_rates_by(const F &give, const std::function<void()> &more);
  template <class F>
  void visit(const MPMPointMap::ActiveBlock &, MPM_NS::SlopeKind, int *box, const F &);
  void sum(std::vector<double> &nodes) const;
  int *box_of(const MPMPointMap::ActiveBlock &);
};

/** most becomes the greatest of itself and of a[p]/b[p] of n points, b > 0, without divisions where it is already. */
inline void raise_ratio(double &most, int n, const double *a, const double *b)
{
  int above = 0;
  for (int p = 0; p < n; p++) above += a[p] > most * b[p];
  for (int p = 0; above && p < n; p++)
    if (a[p] > most * b[p]) most = a[p] / b[p];
}

}    // namespace LAMMPS_NS
#endif
