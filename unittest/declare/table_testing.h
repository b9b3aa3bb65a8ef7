// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

#ifndef MPM_TEST_TABLE_TESTING_H
#define MPM_TEST_TABLE_TESTING_H

// Parts of the manual that are made from declarations in the source. A test compares them with the
// files, or writes the files if MPM_WRITE is set in the environment (tools/tables.sh).

#include "gtest/gtest.h"

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <sstream>
#include <string>

namespace MPM_TEST {

inline std::string text_of_file(const std::string &path)
{
  std::stringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

/** Expects the folder doc/src/name to have exactly these files. wanted: contents by file name. If
 *  MPM_WRITE is set, writes files that differ and removes files that are not wanted. */
inline void expect_up_to_date(const std::string &name,
                              const std::map<std::string, std::string> &wanted)
{
  const std::string folder = MPM_SOURCE_DIR "/doc/src/" + name;
  const bool write = getenv("MPM_WRITE") != nullptr;
  std::string wrong;
  for (const auto &[file, text] : wanted) {
    const std::string path = folder + "/" + file;
    if (text_of_file(path) == text) continue;
    if (!write) {
      wrong += " " + file;
      continue;
    }
    std::filesystem::create_directories(folder);
    ASSERT_TRUE(std::ofstream(path) << text) << path;
    printf("wrote %s\n", path.c_str());
  }
  if (std::filesystem::exists(folder))
    for (const auto &entry : std::filesystem::directory_iterator(folder)) {
      const std::string file = entry.path().filename().string();
      if (file[0] == '.' || wanted.count(file)) continue;
      if (write)
        std::filesystem::remove(entry.path());
      else
        wrong += " " + file + " (of nothing)";
    }
  EXPECT_EQ(wrong, "") << "files in doc/src/" << name << " differ from the declarations: run\n"
                       << "  tools/tables.sh";
}

}    // namespace MPM_TEST
#endif
