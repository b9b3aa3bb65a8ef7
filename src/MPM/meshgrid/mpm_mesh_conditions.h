/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_MESH_CONDITIONS_H
#define LMP_MPM_MESH_CONDITIONS_H

#include "declare/option.h"
#include "mesh/background_mesh.h"
#include "pointers.h"

#include <array>
#include <functional>
#include <string>
#include <vector>

namespace MPM_NS {
using MeshVector = std::array<double, 3>;
}    // namespace MPM_NS

namespace LAMMPS_NS {

/** Condition of a physical group of a mesh. */
struct MPMMeshCondition {
  enum Kind {
    VELOCITY,    ///< prescribed velocity along axes, NULL: free
    SLIP,        ///< no velocity along the normals of the sides
    PRESSURE,    ///< pressure on the sides, which can follow the body
    TRACTION     ///< force per area on the sides as they are in the file
  } kind = VELOCITY;
  std::string group;
  MPM_NS::NumberOrVariable value[3];
};

/** Adds a keyword for conditions of a kind. next: the one that its values are read to. */
template <class Condition>
void add_condition(MPM_NS::Options &o, const std::string &keyword,
                   const std::vector<MPM_NS::OptionValue> &values, decltype(Condition::kind) kind,
                   Condition &next, std::vector<Condition> &conditions)
{
  o.add(keyword, values)
      .then([kind, &next, &conditions] {
        next.kind = kind;
        conditions.push_back(next);
        next = {};
      })
      .standard("none");
}

/** Adds the rule that conditions of a kind are not given twice for a group with one of the first n
 *  values in both. */
template <class Condition>
void refuse_twice(MPM_NS::OptionRules &rules, const std::vector<Condition> &all, int kind,
                  const std::string &keyword, const std::string &advice, int n = 1)
{
  for (std::size_t k = 0; k < all.size(); k++)
    for (std::size_t j = 0; j < k; j++) {
      if (all[j].kind != kind || all[k].kind != kind || all[j].group != all[k].group) continue;
      bool same = false;
      for (int d = 0; d < n; d++) same = same || (all[j].value[d].given && all[k].value[d].given);
      rules.push_back({same, keyword, "is given twice for group " + all[k].group + ": " + advice});
    }
}

/** Conditions on nodes and loads on sides of a mesh. */
class MPMMeshForces : protected Pointers {
 public:
  MPMMeshForces(class LAMMPS *, const MPM_NS::BackgroundMesh &,
                const std::vector<MPMMeshCondition> &);

  /** Start of a run: finds the variables. */
  void init(const std::string &user);
  /** Evaluates the values of this step, on all ranks. */
  void evaluate();
  /** Are there no conditions, and how many are there? */
  bool empty() const { return list.empty(); }
  std::size_t size() const { return list.size(); }

  /** Is there any pressure? */
  bool has_pressure() const { return npressure > 0; }
  /** Is there any pressure or traction? */
  bool has_loads() const;
  /** Lets pressure act on sides whose nodes have moved to these positions. cells: those whose sides
   *  this rank handles. Collective. */
  void follow(const std::vector<char> &cells, const std::vector<MPM_NS::MeshVector> &positions,
              class MPMMeshRanks &ranks);

  /** Start of a run: warns of loads on sides whose nodes have no mass. carries: does this rank
   *  count the node, and does the node have mass? Collective. */
  void warn_of_lost_loads(const std::string &user, const std::function<bool(int)> &carries) const;

  /** Adds a share of the force of all loads on a node [force]. count: include it in the output. */
  void add_load(int node, double share, bool count, double *force);

  /** Applies the conditions of a node to its velocity v. mass_per_time: converts the change to the
   *  force on the body for the output; 0: it is not counted. */
  void constrain(int node, double mass_per_time, double *v);

  /** Resets the sums for the output. */
  void clear_sums();
  /** Force of condition k on the body along axis d, over the nodes that this rank counted. */
  double sum(int k, int d) const { return list[k].sum[d]; }

 private:
  struct Active {
    MPMMeshCondition given;
    double value[3];
    MPM_NS::MeshVector sum;
    int number;    // index among the conditions with a pressure
    std::vector<MPM_NS::BackgroundMesh::Face> sides;
  };
  struct NodeCondition {
    int condition;
    std::vector<MPM_NS::MeshVector> normals;    // for SLIP: unit vectors at right angles
    MPM_NS::MeshVector normal;    // for sides with loads: outward normal with the size of the area
    double area;
  };
  const MPM_NS::BackgroundMesh &mesh;
  std::vector<Active> list;
  int npressure = 0;
  std::vector<double> normals;    // [node][pressure][3]
  std::vector<int> place;         // [node] index in conditions_at_nodes, -1: none
  // conditions of a node: first SLIP, then others, in the order of the input
  std::vector<std::vector<NodeCondition>> conditions_at_nodes;
  bool varies = false;

  NodeCondition &add(int node, int condition);
  void add_slip(int condition);
  void add_sides(int condition);
};

}    // namespace LAMMPS_NS
#endif
