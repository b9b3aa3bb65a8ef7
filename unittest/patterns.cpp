// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

#include "patterns.h"

#include <regex>

bool MPM_TEST::contains(const std::string &text, const std::string &pattern)
{
  return std::regex_search(text, std::regex(pattern));
}
