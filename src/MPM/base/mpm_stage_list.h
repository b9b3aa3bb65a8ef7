/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_MPM_STAGE_LIST_H
#define LMP_MPM_STAGE_LIST_H

#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace LAMMPS_NS {

/** A step as a list of named stages, which run in the order in which they were added. Each stage
 *  names the data that it reads and writes. */
class MPMStageList {
 public:
  struct Stage {
    std::string name;
    std::vector<std::string> reads, writes;
    std::function<void()> run;
  };

  void clear() { stages.clear(); }
  void add(const std::string &name, const std::vector<std::string> &reads,
           const std::vector<std::string> &writes, std::function<void()> run)
  {
    stages.push_back({name, reads, writes, std::move(run)});
  }
  void run() const
  {
    for (const auto &stage : stages) stage.run();
  }
  const std::vector<Stage> &list() const { return stages; }

 private:
  std::vector<Stage> stages;
};

}    // namespace LAMMPS_NS
#endif
