/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_HEAT_FACES_H
#define LMP_MPM_HEAT_FACES_H

#include "declare/option.h"
#include "mpm_diffusion_solver.h"
#include "pointers.h"

#include <cstdint>
#include <functional>
#include <vector>

namespace LAMMPS_NS {
class MPMField;
class MPMHeatBody;

/** What a face of the box does to the heat of what touches it. */
struct MPMHeatCondition {
  enum Kind { INSULATED, TEMPERATURE, FLUX, CONVECTION, RADIATION };

  Kind kind = INSULATED;
  /** Temperature; flux; heat transfer coefficient or emissivity, and temperature outside. */
  MPM_NS::NumberOrVariable value[2];
  double now[2] = {0.0, 0.0};    ///< in this step

  int nvalue() const { return kind == INSULATED ? 0 : (kind <= FLUX ? 1 : 2); }
  /** Heat that comes in per area at a temperature of the surface, if that is not prescribed. sigma: the constant of
   *  Stefan and Boltzmann. */
  double flux(double temperature, double sigma) const;
  /** How much this falls with the temperature. */
  double derivative(double temperature, double sigma) const;
  /** The same, at the most between it and that outside. */
  double slope(double temperature, double sigma) const;
};

/** Heat through the faces of the box, anywhere between nodes, at the nodes of one field.
 *
 *  The temperature at the face is that of the shape functions, sum_k w_k T_k along each line of nodes
 *  normal to it, and heat q through the face goes to these nodes with the same weights. */
class MPMHeatFaces : protected Pointers {
 public:
  static constexpr int NFACE = 6;
  using Heats = std::vector<double>;    ///< of faces, in the order xlo ... zhi, and of sources

  MPMHeatFaces(class LAMMPS *lmp, MPMField &field, const MPMHeatCondition *conditions) :
      Pointers(lmp), field(field), conditions(conditions)
  {
  }

  /** Start of a run: where the faces are. sigma: the constant of Stefan and Boltzmann. */
  void init(double sigma);
  /** Prescribed temperatures are kept exactly also where faces meet: a step may be so long that what they lose in one counts. */
  void hold_exactly() { turns = 20; }
  /** Is there a face that is not insulated? */
  bool any() const { return !faces.empty(); }
  /** Number of axes with faces whose temperature follows that outside. */
  int axes_that_follow() const;
  /** A rank that has a node of a line needs all of them. */
  void extend_topology();
  void topology_changed();

  /** Marks blocks [slot] with nodes of lines. */
  void mark_near(std::vector<char> &near) const;
  /** Lines that touch material in this step, from the capacities and volumes of nodes. body: null, or its surface; ends: in the place of
   *  this sums of V grad N alone, or empty.
   *  rates: raised to the largest rates of this rank at which temperatures at the faces of each axis follow those
   *  outside [1/time]. */
  void begin_step(const std::vector<double> &capacity, const std::vector<double> &volume,
                  const MPMHeatBody *body, const std::vector<double> &ends,
                  const std::vector<double> &temperature, double rates[3]);
  /** Its field is one lattice of several of a body (MPMHeatLevels): nodes at the rim have a part of their volume by their functions. */
  bool is_level = false;
  /** Is a place on the lattice at most so far from a face? */
  bool is_near(const double *place, double distance) const;
  /** Is there a line with heat some nodes of which are taken away and others are not? */
  bool has_part_of_line(const std::function<bool(int64_t)> &taken) const;
  /** Lines for edges of other surfaces. */
  void note_edges(MPMHeatBody &) const;
  /** Where other surfaces have edges with faces, temperatures follow with the rate of conduction at the most. */
  void slow_down_at_edges(const MPMHeatBody &, double conduction);
  /** They follow with this rate at the most. conduction: the bound of its rates; rates: those of all ranks. Returns a bound for
   *  nodes at edges and corners. */
  double limit(double cap, double conduction, const double rates[3]);
  /** Such a bound also before the first step, for this limit and the least capacity per volume [1/time]. */
  double expected_rate(double cap, double capacity) const;
  /** Give the faces with a temperature theirs, by the smallest change in the norm of capacities; adds the heat
   *  of nodes that this rank owns. */
  void hold(std::vector<double> &temperature, Heats &) const;
  /** Add what comes through faces to the rates of temperatures, which have all other heat of the field already, and hold
   *  those that are prescribed; adds the power. */
  void add_rates(const std::vector<double> &temperature, std::vector<double> &rate,
                 Heats &power) const
  {
    add(false, temperature, rate, power);
  }
  /** From here on add_changes() is for small changes of these temperatures. Is all of it symmetric on this rank? */
  bool linearize(const std::vector<double> &temperature);
  void add_changes(const std::vector<double> &change, std::vector<double> &rate) const;
  /** What this rank adds to the matrix of conduction, with prescribed temperatures as stiff exchange: of the size least
   *  [1/time] times this many, and more. */
  void each_term(double least, const MPMDiffusion::Term &) const;
  /** Change the rates so that temperatures that are prescribed stay; adds the power. */
  void hold_rates(std::vector<double> &rate, Heats &) const;

  double memory_usage() const;

 private:
  static constexpr int MOST = 4;    // nodes of a line
  struct Line {
    int64_t node[MOST];
    double weight[MOST];    // in this step, of sum one; all zero: no material touches the face here
    double change[MOST];    // of the temperature of a node by heat: weight over capacity
    double owned;           // sum of the weights of nodes that this rank owns
    double response;        // of the temperature at the face to heat: sum of weight * change
    double area;            // of the material that touches the face
    double rate;            // at which the temperature at the face follows that outside
    double slope;           // fall of the heat per area with the temperature, of add_changes()
    bool joint;             // its power is that of the equations of a group in this step
  };
  struct Face {
    int face, axis, first, n;    // n nodes from the first one on
    double x;                    // where it is
    double weight[MOST];
    double full[MOST];    // volume of the nodes where material fills the box, in cells
    std::vector<Line> lines;
  };
  struct Member {
    const Face *face;
    Line *line;
  };
  /** Lines of several faces that have nodes in common. */
  struct Group {
    std::vector<Member> all, lines;       // lines: with equations in this step
    std::vector<double> factor;           // of their matrix [n*n]
    mutable std::vector<double> power;    // of these lines
  };
  MPMField &field;
  const MPMHeatCondition *conditions;
  double sigma = 0.0;
  std::vector<Face> faces;
  bool crossing = false;    // prescribed temperatures at faces normal to several axes
  int turns = 1;            // that these take
  std::vector<Group> groups;
  double fastest = 0.0;    // limit of the rates
  double last[3] = {};     // rates of the last step

  void prepare(const Face &, Line &, const std::vector<double> &capacity,
               const std::vector<double> &volume, const MPMHeatBody *,
               const std::vector<double> &ends) const;
  double width(int64_t node, int axis) const;
  double circle(int64_t node) const;
  bool weigh_by_surface(const Face &, Line &, const std::vector<double> &gradient,
                        const std::function<double(int64_t)> &conducting) const;
  void find_groups();
  void slow_down(Group &, double conduction) const;
  void set_up(Group &) const;
  bool is_limited(const Line &line) const { return line.rate > fastest; }
  double softness(const Face &, const Line &) const;
  void add(bool changes, const std::vector<double> &temperature, std::vector<double> &rate,
           Heats &) const;
  double flux(bool changes, const Face &, const Line &, double T) const;
  void solve(const Group &, bool changes, const std::vector<double> &temperature,
             std::vector<double> &rate, Heats &) const;
  template <class F> void visit_held(const F &) const;
};

}    // namespace LAMMPS_NS
#endif
