/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_STAGE_LIST_H
#define LMP_MPM_STAGE_LIST_H

#include "pointers.h"

#include <algorithm>
#include <functional>
#include <initializer_list>
#include <string>
#include <utility>
#include <vector>

namespace LAMMPS_NS {

/** Names of the data that a stage of a step reads, or writes. Those of points and lattices are
 *  here; steps can have others. */
class MPMStageData {
 public:
  using Name = const char *;
  static constexpr Name POSITION = "x";         ///< of points (atom->x)
  static constexpr Name VELOCITY = "v";         ///< of points (atom->v)
  static constexpr Name AFFINE = "C";           ///< matrices that go to nodes with the velocity
  static constexpr Name DEFORMATION = "F";      ///< gradient of points
  static constexpr Name STRESS = "tau";         ///< of points
  static constexpr Name HISTORY = "history";    ///< variables of the laws of points
  static constexpr Name MASS = "mass";          ///< of points
  static constexpr Name FORCE = "f";            ///< on all atoms (atom->f, atom->torque)
  static constexpr Name NODES = "nodes";        ///< their mass, momentum or velocity, force
  static constexpr Name BLOCKS = "blocks";      ///< active blocks, and the points in each
  static constexpr Name OWN = "own";            ///< what the owner of the stage keeps itself

  MPMStageData(std::initializer_list<Name> list) : names(list.begin(), list.end()) {}
  MPMStageData operator+(const MPMStageData &other) const
  {
    MPMStageData sum = *this;
    for (const auto &name : other.names)
      if (!has(name)) sum.names.push_back(name);
    return sum;
  }
  bool has(const std::string &name) const
  {
    return std::find(names.begin(), names.end(), name) != names.end();
  }
  const std::vector<std::string> &list() const { return names; }
  std::string text() const
  {
    std::string text;
    for (const auto &name : names) text += (text.empty() ? "" : " ") + name;
    return text;
  }

 private:
  std::vector<std::string> names;
};

/** A step as a list of named stages, in the order in which they were added. The cost of each is
 *  measured. */
class MPMStageList {
 public:
  using Data = MPMStageData;

  /** What a stage does for one of several fields, or for all of them. */
  struct Part {
    std::string owner;    ///< the field; empty: all
    std::function<void()> run;
    double seconds = 0.0;    ///< spent so far
  };
  struct Stage {
    std::string name;
    Data reads, writes;
    std::vector<Part> parts;
  };
  /** Is called before (done is false) and after each part of a stage. */
  using Observer = std::function<void(const Stage &, bool done)>;

  void clear() { stages.clear(); }
  void add(const std::string &name, const Data &reads, const Data &writes, std::vector<Part> parts)
  {
    stages.push_back({name, reads, writes, std::move(parts)});
  }
  void add(const std::string &name, const Data &reads, const Data &writes,
           std::function<void()> run)
  {
    add(name, reads, writes, std::vector<Part>{{"", std::move(run)}});
  }
  void run()
  {
    double time = platform::walltime();
    for (auto &stage : stages)
      for (auto &part : stage.parts) {
        if (observer) observer(stage, false);
        part.run();
        if (observer) observer(stage, true);
        const double now = platform::walltime();
        part.seconds += now - time;
        time = now;
      }
  }
  void clear_costs()
  {
    for (auto &stage : stages)
      for (auto &part : stage.parts) part.seconds = 0.0;
  }
  void observe(Observer use) { observer = std::move(use); }
  const std::vector<Stage> &list() const { return stages; }
  /** A line for each stage: name, owners, what it reads and writes. */
  std::string text() const
  {
    std::string text;
    for (const auto &stage : stages) {
      std::string name = stage.name;
      for (const auto &part : stage.parts)
        if (!part.owner.empty()) name += " " + part.owner;
      text += fmt::format("  {:<40} {} -> {}\n", name, stage.reads.text(), stage.writes.text());
    }
    return text;
  }

 private:
  std::vector<Stage> stages;
  Observer observer;
};

}    // namespace LAMMPS_NS
#endif
