// This file is part of the MPM package for LAMMPS, distributed under the GNU General Public License,
// version 2; see the file LICENSE.

#ifndef MPM_BAD_INPUT_TESTING_H
#define MPM_BAD_INPUT_TESTING_H

// Mistakes in an input: a good scene with one thing changed, in a LAMMPS instance of its own, must
// give an error that says what is wrong. A scene that would run forever is killed by a timer, which counts
// processor time: a busy machine changes nothing.

#include "mpm_lammps.h"

#include <regex>
#include <string>
#include <sys/time.h>

namespace MPM_TEST {

constexpr int SECONDS_PER_CASE = 60;

/** This process ends by a signal once it has used so many seconds of processor time; 0: never. */
inline void allow_seconds(int seconds)
{
  itimerval timer = {};
  timer.it_value.tv_sec = seconds;
  setitimer(ITIMER_PROF, &timer, nullptr);
}

/** What LAMMPS says to an input, in time: the text of its error, or nothing. */
inline std::string answer(const std::string &input)
{
  allow_seconds(SECONDS_PER_CASE);
  const std::string text = error_of(input);
  allow_seconds(0);
  return text;
}

inline bool contains(const std::string &text, const std::string &pattern)
{
  return std::regex_search(text, std::regex(pattern));
}

inline std::string changed(std::string text, const std::string &from, const std::string &to)
{
  const auto at = text.find(from);
  if (at == std::string::npos) return "no '" + from + "' in the scene";
  return text.replace(at, from.size(), to);
}

/** A mistake: this part of the good scene becomes that, and the error matches a pattern. */
struct Change {
  std::string name, from, to, error;
  friend void PrintTo(const Change &mistake, std::ostream *out) { *out << mistake.to; }
};

/** Mistakes in one line of the scene: what comes after its first words. */
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

inline void expect_explained(const std::string &good_scene, const Change &mistake)
{
  const std::string text = answer(changed(good_scene, mistake.from, mistake.to));
  EXPECT_FALSE(text.empty()) << "no error";
  EXPECT_TRUE(contains(text, mistake.error))
      << "expected: " << mistake.error << "\nfound: " << text;
}

}    // namespace MPM_TEST
#endif
