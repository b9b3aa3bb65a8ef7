/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef MPM_TEST_TABLE_TESTING_H
#define MPM_TEST_TABLE_TESTING_H

// Parts of the manual that are made from declarations in the source: a test compares them with the
// files, and writes the files when MPM_WRITE is set in the environment (tools/tables.sh).

#include "gtest/gtest.h"

#include <cstdio>
#include <cstdlib>
#include <dirent.h>
#include <map>
#include <set>
#include <string>
#include <sys/stat.h>

namespace MPM_TEST {

inline std::string text_of_file(const std::string &path)
{
  std::string text;
  if (FILE *fp = fopen(path.c_str(), "r")) {
    for (int c; (c = fgetc(fp)) != EOF;) text += static_cast<char>(c);
    fclose(fp);
  }
  return text;
}

/** The files in a folder of doc/src are these: name, contents. */
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
    mkdir(folder.c_str(), 0777);
    FILE *fp = fopen(path.c_str(), "w");
    ASSERT_NE(fp, nullptr) << path;
    fputs(text.c_str(), fp);
    fclose(fp);
    printf("wrote %s\n", path.c_str());
  }
  if (DIR *dir = opendir(folder.c_str())) {
    while (const dirent *entry = readdir(dir)) {
      const std::string file = entry->d_name;
      if (file[0] == '.' || wanted.count(file)) continue;
      if (write)
        remove((folder + "/" + file).c_str());
      else
        wrong += " " + file + " (of nothing)";
    }
    closedir(dir);
  }
  EXPECT_EQ(wrong, "") << "files in doc/src/" << name << " differ from the declarations: run\n"
                       << "  tools/tables.sh";
}

}    // namespace MPM_TEST
#endif
