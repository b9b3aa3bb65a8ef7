/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "output/fix_mpm_record.h"

#include "base/mpm_input.h"
#include "base/mpm_options.h"

#include "comm.h"
#include "error.h"
#include "update.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <stdexcept>

using namespace LAMMPS_NS;
using namespace MPM_NS;

/** fix ID group mpm/record FILE keyword value ... */
Options MPMRecordOptions::declare()
{
  using namespace option;
  Options o("fix mpm/record");
  o.add("start",
        {number(start, "T", ANY_NUMBER, "time", "simulation time at the time 0 of the file")});
  o.add("hold", {yes_no(hold)},
        "outside the record, use its first and last values (yes) or 0 (no)");
  return o;
}

FixMPMRecord::FixMPMRecord(LAMMPS *lmp, int narg, char **arg) : Fix(lmp, narg, arg)
{
  if (narg < 4) error->all(FLERR, Error::NOLASTLINE, "Fix mpm/record needs the name of a file");
  Options options = declare();
  read_options(lmp, options, narg, arg, 4);

  std::string message;
  if (comm->me == 0) {
    try {
      read(arg[3]);
    } catch (const std::exception &e) {
      message = e.what();
    }
  }
  broadcast(message, world);
  if (!message.empty()) error->all(FLERR, 3, "Fix mpm/record: {}: {}", arg[3], message);
  MPI_Bcast(&ncolumn, 1, MPI_INT, 0, world);
  broadcast(rows, world);

  const std::size_t n = nrow();
  integrals.assign(n * ncolumn, 0.0);
  for (std::size_t k = 1; k < n; k++)
    for (int c = 0; c < ncolumn; c++)
      integrals[k * ncolumn + c] = integrals[(k - 1) * ncolumn + c] +
          0.5 * (at(k, 0) - at(k - 1, 0)) * (at(k, 1 + c) + at(k - 1, 1 + c));

  scalar_flag = vector_flag = 1;
  size_vector = 2 * ncolumn;
  global_freq = 1;
  extscalar = extvector = 0;
}

/** Rows of numbers between blanks, commas, or semicolons. */
void FixMPMRecord::read(const std::string &file)
{
  std::ifstream in(file);
  if (!in) throw std::runtime_error("cannot open this file");
  ncolumn = -1;
  std::string line;
  bool names = false;
  for (bigint number = 1; std::getline(in, line); number++) {
    const auto fail = [&](const std::string &what) {
      throw std::runtime_error("line " + std::to_string(number) + ": " + what);
    };
    for (char &c : line)
      if (c == ',' || c == ';' || c == '\t' || c == '\r') c = ' ';
    std::size_t from = line.find_first_not_of(' '), n = 0;
    if (from == std::string::npos || line[from] == '#') continue;
    for (; from != std::string::npos; n++) {
      const std::size_t to = std::min(line.find(' ', from), line.size());
      const std::string word = line.substr(from, to - from);
      char *end;
      const double value = strtod(word.c_str(), &end);
      if (*end) {
        if (!rows.empty() || n > 0 || names) fail("'" + word + "' is not a number");
        names = true;    // the first line may have those of columns
        break;
      }
      if (!std::isfinite(value)) fail("'" + word + "' is not finite");
      rows.push_back(value);
      from = line.find_first_not_of(' ', to);
    }
    if (rows.empty()) continue;
    if (ncolumn < 0) ncolumn = (int) n - 1;
    if (ncolumn < 1) fail("there must be a time and at least one value");
    if ((int) n != 1 + ncolumn)
      fail("there are " + std::to_string(n) + " numbers, and " + std::to_string(1 + ncolumn) +
           " before");
    const std::size_t last = rows.size() / n - 1;
    if (last > 0 && !(at(last, 0) > at(last - 1, 0))) fail("times must become larger");
  }
  if (ncolumn < 1 || rows.size() < 2 * (1 + (std::size_t) ncolumn))
    throw std::runtime_error("there must be two rows of numbers or more");
}

/** Values of the columns, and after them their integrals. */
double FixMPMRecord::compute_vector(int k)
{
  constexpr double ROUND_OFF = 1.0e-12;    // of the times of the file, in which steps end at rows

  // as the word time of thermo_style has it

  double t = update->atime + (update->ntimestep - update->atimestep) * update->dt - start;
  const bool integral = k >= ncolumn;
  const int c = k % ncolumn;
  const std::size_t n = nrow();
  for (const double end : {at(0, 0), at(n - 1, 0)})
    if (std::fabs(t - end) <= ROUND_OFF * std::max(at(n - 1, 0) - at(0, 0), std::fabs(start)))
      t = end;
  if (t < at(0, 0) || t > at(n - 1, 0)) {
    const std::size_t end = t < at(0, 0) ? 0 : n - 1;
    const double value = hold ? at(end, 1 + c) : 0.0;
    return integral ? integrals[end * ncolumn + c] + value * (t - at(end, 0)) : value;
  }
  std::size_t low = 0, high = n - 1;
  while (high - low > 1) {
    const std::size_t middle = (low + high) / 2;
    (at(middle, 0) <= t ? low : high) = middle;
  }
  const double width = at(high, 0) - at(low, 0), part = t - at(low, 0);
  const double value = at(low, 1 + c) + part / width * (at(high, 1 + c) - at(low, 1 + c));
  return integral ? integrals[low * ncolumn + c] + 0.5 * part * (at(low, 1 + c) + value) : value;
}
