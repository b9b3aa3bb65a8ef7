// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public
// License, version 2; see the file LICENSE.

#ifndef MPM_BAD_INPUT_TESTING_H
#define MPM_BAD_INPUT_TESTING_H

// Tests of mistakes in an input. A good scene with one change, in a LAMMPS instance of its own,
// must give an error that explains the mistake. A timer kills a scene that would run forever. It
// counts processor time, so that the tests also pass on a busy machine.

#include "mpm_lammps.h"
#include "patterns.h"

#include <string>
#include <sys/time.h>

namespace MPM_TEST {

constexpr int SECONDS_PER_CASE = 60;

/** Ends this process by a signal once it has used this many seconds of processor time; 0: never. */
inline void allow_seconds(int seconds)
{
  itimerval timer = {};
  timer.it_value.tv_sec = seconds;
  setitimer(ITIMER_PROF, &timer, nullptr);
}

/** The message of the error that an input gives within the time allowed; empty if it gives none. */
inline std::string answer(const std::string &input)
{
  allow_seconds(SECONDS_PER_CASE);
  const std::string text = error_of(input);
  allow_seconds(0);
  return text;
}

/** The text with the first occurrence of from replaced by to; of nothing: with to before its last
 *  run. */
inline std::string changed(std::string text, const std::string &from, const std::string &to)
{
  if (from.empty()) return text.insert(text.rfind("\nrun ") + 1, to + "\n");
  const auto at = text.find(from);
  if (at == std::string::npos) return "no '" + from + "' in the scene";
  return text.replace(at, from.size(), to);
}

/** A mistake: from, a part of the good scene, is replaced by to, or to comes before the last run if
 *  from is empty. error: pattern of the message. */
struct Change {
  std::string name, from, to, error;
  friend void PrintTo(const Change &mistake, std::ostream *out) { *out << mistake.to; }
};

/** Mistakes in one line of the scene, whose first words stay as they are. rows: name of the test,
 *  new rest of the line, and pattern of the error. */
inline std::vector<Change> mistakes_in(const std::string &line, const std::string &words,
                                       const std::vector<std::array<const char *, 3>> &rows)
{
  std::vector<Change> all;
  for (const auto &[name, rest, error] : rows)
    all.push_back({name, line, words + " " + rest + "\n", error});
  return all;
}

inline std::string case_name(const ::testing::TestParamInfo<Change> &info)
{
  return info.param.name;
}

/** Expects that the scene with this mistake gives the error that explains it. */
inline void expect_explained(const std::string &good_scene, const Change &mistake)
{
  const std::string text = answer(changed(good_scene, mistake.from, mistake.to));
  EXPECT_FALSE(text.empty()) << "no error";
  EXPECT_TRUE(contains(text, mistake.error))
      << "expected: " << mistake.error << "\nfound: " << text;
}

}    // namespace MPM_TEST
#endif
