/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_HEAT_FACES_H
#define LMP_MPM_HEAT_FACES_H

#include "declare/option.h"
#include "diffusion/mpm_diffusion_solver.h"
#include "field/node_line.h"
#include "pointers.h"

#include <cstdint>
#include <functional>
#include <vector>

namespace LAMMPS_NS {
class MPMField;
class MPMHeatBody;

/** Heat condition at a face of the box. */
struct MPMHeatCondition {
  enum Kind { INSULATED, TEMPERATURE, FLUX, CONVECTION, RADIATION };

  Kind kind = INSULATED;
  /** Temperature; or flux; or heat transfer coefficient or emissivity, and outside temperature. */
  MPM_NS::NumberOrVariable value[2];
  double now[2] = {0.0, 0.0};    ///< values in this step

  int nvalue() const { return kind == INSULATED ? 0 : (kind <= FLUX ? 1 : 2); }
  /** Heat flux into the body per area at this temperature of the surface; for conditions that do
   *  not prescribe the temperature. sigma: the Stefan-Boltzmann constant. */
  double flux(double temperature, double sigma) const;
  /** Decrease of the flux per unit of temperature. */
  double derivative(double temperature, double sigma) const;
  /** The largest value of the derivative between this temperature and the outside temperature. */
  double slope(double temperature, double sigma) const;
};

/** Heat through the faces of the box, which may lie anywhere between nodes, at the nodes of one
 *  field.
 *
 *  The temperature at the face follows from the shape functions, sum_k w_k T_k along each line of
 *  nodes normal to the face. Heat q through the face goes to these nodes with the same weights. */
class MPMHeatFaces : protected Pointers {
 public:
  static constexpr int NFACE = 6;
  using Heats = std::vector<double>;    ///< heat of faces, in the order xlo ... zhi, and of sources

  MPMHeatFaces(class LAMMPS *lmp, MPMField &field, const MPMHeatCondition *conditions) :
      Pointers(lmp), field(field), conditions(conditions)
  {
  }

  /** Start of a run: finds the faces. sigma: the Stefan-Boltzmann constant. */
  void init(double sigma);
  /** Keeps prescribed temperatures exactly also where faces meet: for steps so long that the loss
   *  in a single step matters. */
  void hold_exactly() { turns = 20; }
  /** Is there a face that is not insulated? */
  bool any() const { return !faces.empty(); }
  /** Number of axes with faces whose temperature follows the outside temperature. */
  int axes_that_follow() const;
  /** Activates blocks so that a rank that has one node of a line has all of them. */
  void extend_topology();
  /** The blocks of the field are new: lists the lines again. */
  void topology_changed();

  /** Marks the blocks [slot] that contain nodes of lines. */
  void mark_near(std::vector<char> &near) const;
  /** Finds the lines that touch material in this step, from the capacities and volumes of nodes.
   *  body: its surface, or null; ends: sums of V grad N to be used in place of the body, or empty.
   *  rates: raised to the largest rates on this rank at which temperatures at the faces of each
   *  axis follow the outside temperature [1/time]. */
  void begin_step(const std::vector<double> &capacity, const std::vector<double> &volume,
                  const MPMHeatBody *body, const std::vector<double> &ends,
                  const std::vector<double> &temperature, double rates[3]);
  /** The field is one of several lattices of a body (MPMHeatLevels): the functions of nodes at its
   *  rim cover only a part of their volume. */
  bool is_level = false;
  /** Is a place on the lattice within this distance of a face? */
  bool is_near(const double *place, double distance) const;
  /** Is there a line with heat of which some, but not all, nodes are taken? */
  bool has_part_of_line(const std::function<bool(int64_t)> &taken) const;
  /** Notes the lines of the faces for edges of other surfaces. */
  void note_edges(MPMHeatBody &) const;
  /** At edges of faces with other surfaces, limits the rate at which temperatures follow to the
   *  rate of conduction. */
  void slow_down_at_edges(const MPMHeatBody &, double conduction);
  /** Limits the rate at which temperatures follow to cap. conduction: bound of the rates of
   *  conduction; rates: largest rates of all ranks. Returns a bound for nodes at edges and
   *  corners. */
  double limit(double cap, double conduction, const double rates[3]);
  /** The same bound, available also before the first step, for the limit cap and the least capacity
   *  per volume [1/time]. */
  double expected_rate(double cap, double capacity) const;
  /** Sets the prescribed temperatures of faces by the smallest change in the norm of capacities.
   *  Adds the heat of nodes that this rank owns. */
  void hold(std::vector<double> &temperature, Heats &) const;
  /** Adds the heat through faces to the rates of temperatures, which must include all other heat of
   *  the field already, and keeps prescribed temperatures fixed. changes: temperatures are small
   *  changes from those of linearize(). Adds the power. */
  void add_rates(bool changes, const std::vector<double> &temperature, std::vector<double> &rate,
                 Heats &power) const;
  /** Linearizes the conditions around these temperatures. Returns true if the
   *  result is symmetric on this rank. */
  bool linearize(const std::vector<double> &temperature);
  /** Passes on the terms that this rank adds to the matrix of conduction. Prescribed temperatures
   *  become a stiff exchange, whose rate is a large multiple of least [1/time]. */
  void each_term(double least, const MPMDiffusion::Term &) const;
  /** Changes the rates so that prescribed temperatures stay. Adds the power. */
  void hold_rates(std::vector<double> &rate, Heats &) const;

  double memory_usage() const;

 private:
  // weights are those in this step, with the sum one; all zero: no material touches the face here
  struct Line : NodeLine {
    double change[MOST];    // change of the temperature of a node by heat: weight over capacity
    double owned;           // sum of the weights of nodes that this rank owns
    double response;    // response of the temperature at the face to heat: sum of weight * change
    double area;        // area of the material that touches the face
    double rate;        // rate at which the temperature at the face follows the outside temperature
    double slope;       // decrease of the flux per unit of temperature, for small changes
    bool joint;         // its power comes from the equations of a group in this step
  };
  struct Face {
    int face, axis, first, n;    // n nodes from the first one on
    double x;                    // position of the face
    double weight[NodeLine::MOST];
    double full[NodeLine::MOST];    // volume of the nodes if material fills the box, in cells
    std::vector<Line> lines;
    // prescribed temperature: lines that have nodes in common with other such lines
    std::vector<int> crossing;
  };
  struct Member {
    const Face *face;
    Line *line;
  };
  /** Lines of several faces that have nodes in common. */
  struct Group {
    std::vector<Member> all, lines;       // lines: with equations in this step
    std::vector<double> factor;           // factors of their matrix [n*n]
    mutable std::vector<double> power;    // power of these lines
  };
  MPMField &field;
  const MPMHeatCondition *conditions;
  double sigma = 0.0;
  std::vector<Face> faces;
  bool crossing = false;    // prescribed temperatures at faces normal to several axes
  int turns = 1;            // number of passes for these
  std::vector<Group> groups;
  double fastest = 0.0;    // upper limit of the rates
  double last[3] = {};     // rates of the last step

  void prepare(const Face &, Line &, const std::vector<double> &capacity,
               const std::vector<double> &volume, const MPMHeatBody *,
               const std::vector<double> &ends) const;
  double width(int64_t node, int axis) const;
  double circle(int64_t node) const;
  bool weigh_by_surface(const Face &, Line &, const std::vector<double> &gradient,
                        const std::function<double(int64_t)> &conducting) const;
  void find_groups();
  void find_crossing();
  bool is_held(const Face &face) const
  {
    return conditions[face.face].kind == MPMHeatCondition::TEMPERATURE;
  }
  void slow_down(Group &, double conduction) const;
  void set_up(Group &) const;
  bool is_limited(const Line &line) const { return line.rate > fastest; }
  double softness(const Face &, const Line &) const;
  /** Heat per area that comes in, or its change for a change of the temperature. */
  double flux(bool changes, const Face &face, const Line &line, double T) const
  {
    return changes ? -line.slope * T : conditions[face.face].flux(T, sigma);
  }
  void solve(const Group &, bool changes, const std::vector<double> &temperature,
             std::vector<double> &rate, Heats &) const;
  template <class F> void visit_held(const F &) const;
};

}    // namespace LAMMPS_NS
#endif
