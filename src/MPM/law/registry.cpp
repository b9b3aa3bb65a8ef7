/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

// All laws: those of the package, from law/list.h, and those that plugins have added.

#include "law/list.h"

#include <cstring>
#include <memory>

using namespace MPM_NS;

namespace {

template <Part PART, class... Laws> void declare(law::Family<PART, Laws...>, LawList *laws)
{
  (laws[PART].push_back(law::declaration<Laws>()), ...);
}

struct Registry {
  LawList laws[NPARTS];
  std::size_t nbuiltin[NPARTS];
  std::deque<LawKernels> added[NPARTS];    ///< kernels of the laws behind the first nbuiltin

  Registry()
  {
#define MPM_DECLARE(family) declare(law::family(), laws);
    MPM_LAW_FAMILIES(MPM_DECLARE)
    for (int part = 0; part < NPARTS; part++) nbuiltin[part] = laws[part].size();
  }
};

Registry &registry()
{
  static Registry r;
  return r;
}

}    // namespace

const LawList &MPM_NS::declared_laws(Part part)
{
  return registry().laws[part];
}

/** Laws of a plugin, which may be loaded several times; deques leave the others where they are. */
std::string MPM_NS::add_laws(const LawVersion &version, const PluginLaw *laws, int n)
{
  if (memcmp(&version, &law_version, sizeof(version)) != 0)
    return "it was compiled with the headers of another version of the MPM package: compile it "
           "again with those of this one";
  Registry &r = registry();
  for (int k = 0; k < n; k++) {
    const PluginLaw &law = laws[k];
    auto &list = r.laws[law.part];
    std::size_t same = 0;
    while (same < list.size() && strcmp(list[same].name, law.info.name) != 0) same++;
    if (same == list.size()) {
      list.push_back(law.info);
      r.added[law.part].push_back(law.kernels);
    } else if (same < r.nbuiltin[law.part] ||
               r.added[law.part][same - r.nbuiltin[law.part]].update != law.kernels.update) {
      return std::string("there is another law '") + law.info.name +
          "' already: give yours another name";
    }
  }
  return "";
}

/* ----------------------------------------------------------------------
   one table for each instruction set that the build has
------------------------------------------------------------------------- */

namespace MPM_NS {
MPM_DECLARE_ISA(void, mpm_laws_common, LawTable &)
#define MPM_DECLARE_KERNELS(family) MPM_DECLARE_ISA(const LawKernels *, mpm_laws_##family)
MPM_LAW_FAMILIES(MPM_DECLARE_KERNELS)
}    // namespace MPM_NS

static LawTable make_table(InstructionSet set)
{
  LawTable table;
  void (*const common[])(LawTable &) = MPM_ALL_ISA(mpm_laws_common);
  common[set](table);
#define MPM_ADD_KERNELS(family)                                         \
  {                                                                     \
    const LawKernels *(*const of[])() = MPM_ALL_ISA(mpm_laws_##family); \
    auto &list = table.builtin[law::family::part];                      \
    list.insert(list.end(), of[set](), of[set]() + law::family::size);  \
  }
  MPM_LAW_FAMILIES(MPM_ADD_KERNELS)
  return table;
}

const LawTable *LawTable::select(const char *isa)
{
  static std::unique_ptr<const LawTable> tables[REFERENCE + 1];
  InstructionSet set;
  if (!select_isa(isa, set)) return nullptr;
  if (!tables[set]) tables[set] = std::make_unique<LawTable>(make_table(set));
  return tables[set].get();
}

const LawKernels &LawTable::kernels(Part part, int index) const
{
  const int n = builtin[part].size();
  return index < n ? builtin[part][index] : registry().added[part][index - n];
}
