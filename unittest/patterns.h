// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

#ifndef MPM_PATTERNS_H
#define MPM_PATTERNS_H

#include <string>

namespace MPM_TEST {

/** Whether a regular expression matches a part of the text. (The header regex takes seconds to
 *  compile.) */
bool contains(const std::string &text, const std::string &pattern);

}    // namespace MPM_TEST
#endif
