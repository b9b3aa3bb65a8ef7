/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/* Each body has its own velocity field. Where two of them have mass at a node and touch
   (MPMContactSearch), impulses between them follow from the law of contact (MPMNodeContact), at all
   nodes of an explicit step (MPMContactSolver). In implicit steps a solver decides with
   MPMContactTrial. */

#include "contact/fix_mpm_contact.h"

#include "base/mpm_find_fixes.h"
#include "base/mpm_lists.h"
#include "base/mpm_options.h"
#include "base/mpm_state.h"
#include "comm.h"
#include "domain.h"
#include "error.h"
#include "field/mpm_field.h"
#include "field/mpm_forces.h"
#include "field/mpm_interfaces.h"
#include "field/mpm_smoothing.h"
#include "force.h"
#include "modify.h"

#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;
using namespace MPM_NS;

static constexpr int LOOK_EVERY = 50;    // steps after which ranks compare what they have seen
// opening at which bonds have broken, in node spacings: nodes lose area as bodies part
static constexpr double REACH = 0.25;

/** fix ID all mpm/contact FIELD FIELD ...  law ... normal ... gap ... */
Options MPMContactOptions::declare()
{
  using namespace option;
  Options o("fix mpm/contact");
  declare_law(o, true);
  o.add(
      "normal",
      {word(normal_by,
            {{"colinear", COLINEAR}, {"volume", VOLUME}, {"mass", MASS}, {"logistic", LOGISTIC}})},
      "how the normal of the interface is computed from the bodies");
  o.add("gap",
        {word(gap,
              {{"no", false, "bodies are in contact as soon as they have nodes in common"},
               {"yes",
                true,
                "bodies are in contact when they touch",
                {optional(number(full, "share", {0.5, 1.0, true}, "",
                                 "share of the volume of a node that bodies fill when they touch; "
                                 "default: 1"))}}})});
  cohesion.declare_keywords(o, bonded);
  heat.declare(
      o,
      "the energy lost by friction becomes heat, which two bodies share in the ratio of their "
      "effusivities :math:`\\sqrt{k \\rho c}`",
      "share of this energy for the body that is named first; the other body gets the rest");
  o.refuse([=] {
    const bool slides = law == ADHESIVE || (law == COULOMB && friction.kinetic > 0.0);
    const bool coheres = law == COHESIVE;
    const auto needs_cohesion = [=](bool given, const char *keyword) {
      return OptionRule{given && !coheres, keyword, "belongs to law cohesive: drop it"};
    };
    return OptionRules{
        {heat.heats() && coheres, "heat",
         "is not known to law cohesive: drop the keyword, or use law coulomb or adhesive"},
        needs_cohesion(cohesion.softening != MPMCohesiveLaw::LINEAR, "softening"),
        needs_cohesion(cohesion.stiffness > 0.0, "stiffness"),
        needs_cohesion(cohesion.mixing != 1.0, "mixing"),
        needs_cohesion(!bonded.empty(), "bonded"),
        {coheres && !gap, "law", "cohesive must know where bodies touch: drop gap no"},
        {coheres && normal_by == MASS, "law",
         "cohesive needs the area of the interface: use normal volume or colinear"},
        {heat.heats() && !slides, "heat",
         "is that of friction: use law coulomb or adhesive, or drop the keyword"},
        coefficients(),
        {law == ADHESIVE && (normal_strength == 0.0 || release_work == 0.0), "law",
         "adhesive needs a positive normal strength and work of release: use frictionless or "
         "coulomb for bodies that do not adhere"},
        {law == ADHESIVE && !gap, "law",
         "adhesive must know how far bodies are apart: drop gap no"},
        {law == ADHESIVE && normal_by == MASS, "law",
         "adhesive needs the area of the interface: use normal volume or colinear"}};
  });
  return o;
}

FixMPMContact::FixMPMContact(LAMMPS *lmp, int narg, char **arg) :
    FixMPMState(lmp, narg, arg), bodies(lmp), search(lmp, *this, *this, *this, bodies),
    solver(lmp, *this, bodies), trial(lmp, *this, *this, *this, bodies, search, contacts),
    report(lmp)
{
  if (igroup != 0)
    error->all(FLERR, 1,
               "Fix mpm/contact acts on nodes, which have no group: use group all; the bodies are "
               "the fields that are named");

  Options options = declare();
  int iarg = 3;
  while (iarg < narg && !options.has(arg[iarg])) {
    if (std::count(names.begin(), names.end(), arg[iarg]))
      error->all(FLERR, iarg, "Fix mpm/contact field {} is named twice", arg[iarg]);
    names.emplace_back(arg[iarg++]);
  }
  if (names.size() < 2)
    error->all(FLERR, MIN(3, narg - 1),
               "Fix mpm/contact needs the IDs of two or more fix mpm, one for each body");
  if (names.size() > MPMContactBodies::MOST)
    error->all(FLERR, 3 + MPMContactBodies::MOST,
               "Fix mpm/contact takes at most {} bodies, as many as LAMMPS has groups",
               MPMContactBodies::MOST);
  read_options(lmp, options, narg, arg, iarg);
  report.set_bodies((int) names.size());
  complete();
  pressure_unit = force->ftm2v / force->nktv2p;
  bodies.by_mass = normal_by == MASS;
  if (heat.heats()) heating = std::make_unique<MPMFrictionHeat>(lmp, heat);
  if (law == COHESIVE) {
    const MPMContactLaw &as_law = *this;
    interface =
        std::make_unique<MPMCohesiveInterface>(lmp, *this, as_law, bodies, search, array_atom);
    state.declare(array_atom, "mpm/contact:bond", MPMCohesiveInterface::WIDTH,
                  [](int, double *row) {
                    row[MPMCohesiveInterface::DAMAGE] = MPMCohesiveInterface::NO_BOND;
                    std::fill_n(row + MPMCohesiveInterface::OPENING, 3, 0.0);
                  });
    keep_arrays();
    peratom_flag = 1;
    peratom_freq = 1;
    size_peratom_cols = MPMCohesiveInterface::WIDTH;
  }

  scalar_flag = array_flag = 1;
  size_array_rows = (int) report.entries.size();
  size_array_cols = MPMContactReport::COLUMNS;
  global_freq = 1;
  extscalar = extarray = 1;
  restart_global = 1;
}

void FixMPMContact::init()
{
  find_bodies();
  check_bodies();
  check_other_contacts();
  if (in_implicit_steps) refuse_implicit_steps();

  bodies.begin_run();
  search.begin_run();
  solver.begin_run();
  trial.begin_run();
  steps = 0;
}

void FixMPMContact::find_bodies()
{
  bodies.list.clear();
  bodies.on_several_lattices = false;
  for (const auto &name : names) {
    auto *field = MPMField::find(lmp, name);
    if (!field)
      error->all(FLERR, Error::NOLASTLINE,
                 "Fix mpm/contact {}: {} is not the ID of a fix mpm: define one fix mpm for each "
                 "body",
                 id, name);
    bodies.list.push_back({field});
  }
}

void FixMPMContact::check_bodies()
{
  const MPMField &first = *bodies[0].field;
  for (auto &body : bodies.list) {
    check_refined(body);
    const MPMField *field = body.field;
    const auto &lattice = field->lattice;
    if (lattice.h != first.lattice.h || field->options.shape != first.options.shape ||
        !std::equal(lattice.origin, lattice.origin + 3, first.lattice.origin))
      error->all(FLERR, Error::NOLASTLINE,
                 "Fix mpm/contact {}: fields {} and {} must have the same lattice (node spacing "
                 "and origin) and shape function; bodies on different lattices meet through a pair "
                 "style",
                 id, first.id(), field->id());
    refuse_field(lmp, *this, *field,
                 {{field->options.total, "frame total",
                   "its nodes are not where the body is: let bodies meet through a pair style"},
                  {field->options.stress_before(), "scheme usf and usavg",
                   "these need the contact before it is known: use usl or musl"}});
  }
  check_cohesion();
  if (law == ADHESIVE && 2.0 * release_work / normal_strength > first.lattice.h)
    error->all(FLERR, Error::NOLASTLINE,
               "Fix mpm/contact {}: adhesion ends at a gap of 2 * work / strength = {}, which is "
               "more than the node spacing {}: raise the strength or the node spacing",
               id, 2.0 * release_work / normal_strength, first.lattice.h);
}

void FixMPMContact::check_cohesion() const
{
  if (law != COHESIVE) return;
  if (!bonded.empty() && !domain->get_region_by_id(bonded))
    error->all(FLERR, Error::NOLASTLINE, "Region {} for fix mpm/contact {} bonded does not exist",
               bonded, id);
  for (const double share : {0.0, 1.0}) {
    const double s = cohesion.strength(share), least = s * s / (2.0 * cohesion.energy(share));
    if (cohesion.stiffness > 0.0 && !(cohesion.stiffness > least))
      error->all(FLERR, Error::NOLASTLINE,
                 "Fix mpm/contact {}: with stiffness {}, the energy {} is spent before the "
                 "strength {} is reached: use one above strength^2 / (2 * energy) = {}",
                 id, cohesion.stiffness, cohesion.energy(share), s, least);
  }
  const double last = cohesion.last_opening(), h = bodies[0].field->lattice.h;
  if (last > REACH * h)
    error->all(FLERR, Error::NOLASTLINE,
               "Fix mpm/contact {}: cohesion ends at an opening of {}, which is more than {} of "
               "the node spacing {}: raise the strength or the node spacing",
               id, last, REACH, h);
  for (const auto &body : bodies.list)
    refuse_field(lmp, *this, *body.field,
                 {{body.field->options.scheme != MPMFieldOptions::USL, "this scheme",
                   "law cohesive needs scheme usl"},
                  {pore_pressure(*body.field) != nullptr, "fix mpm/pore",
                   "law cohesive does not know pore water: use another law"}});
}

void FixMPMContact::check_other_contacts() const
{
  for (auto *other : modify->get_fix_by_style("^mpm/contact$")) {
    if (other == this) continue;
    int shared = 0;
    for (const auto &name : names) {
      const auto &theirs = dynamic_cast<FixMPMContact *>(other)->names;
      shared += std::count(theirs.begin(), theirs.end(), name);
    }
    if (shared > 1)
      error->all(FLERR, Error::NOLASTLINE,
                 "Fix mpm/contact {} and {} have two bodies in common: contact between them would "
                 "be counted twice",
                 id, other->id);
  }
}

/** The nodes of a field that is a part of a body also carry the momentum of the points of finer
 *  fields (fix_mpm_refine.cpp). */
void FixMPMContact::check_refined(MPMContactBody &body)
{
  body.refined = nullptr;
  const std::string name = body.field->id();
  for (auto *fix : find_fixes<MPMRefinedBody>(lmp))
    if (fix->has(name)) body.refined = fix;
  if (!body.refined) return;
  body.finer = body.refined->finer_than(name);
  if (body.finer.empty()) return;
  bodies.on_several_lattices = true;
  refuse_field(
      lmp, *this, *body.field,
      {{law == ADHESIVE || law == COHESIVE, "fix mpm/refine",
        "adhesion needs the area of the interface, which nodes share with those of finer "
        "lattices: use another law"},
       {normal_by == LOGISTIC, "fix mpm/refine",
        "normal logistic does not see the points of finer lattices: use colinear or volume"}});
}

void FixMPMContact::refuse_implicit_steps() const
{
  const struct {
    bool given;
    const char *what, *instead;
  } unknown[] = {{law == ADHESIVE, "law adhesive", "use law stick"},
                 {law == COHESIVE, "law cohesive", "use law stick"},
                 {friction.still > friction.kinetic, "a coefficient of static friction",
                  "use one coefficient"},
                 {normal_by != COLINEAR,
                  "normal mass, volume, and logistic, as they take the one of the interface itself",
                  "remove normal"},
                 {heating != nullptr, "heat", "remove it"},
                 {bodies.on_several_lattices, "bodies on several lattices (fix mpm/refine)",
                  "use one lattice"}};
  for (const auto &[given, what, instead] : unknown)
    if (given)
      error->all(FLERR, Error::NOLASTLINE,
                 "Fix mpm/contact {}: implicit steps (fix mpm/implicit) do not know {}: {}, or "
                 "explicit steps",
                 id, what, instead);
}

/** Called by fix mpm, whose init() may come before this one; a missing field is found here. */
void FixMPMContact::init_action()
{
  in_implicit_steps = !modify->get_fix_by_style("^mpm/implicit$").empty();
  bodies.all_near = in_implicit_steps;
  if (!heating) return;
  FixMPMContact::init();
  std::vector<MPMField *> fields;
  for (const auto &body : bodies.list) fields.push_back(body.field);
  heating->begin_run(*this, fields);
  const auto musl = std::find_if(fields.begin(), fields.end(), [](const MPMField *field) {
    return field->options.scheme == MPMFieldOptions::MUSL;
  });
  if (musl != fields.end() && comm->me == 0)
    error->warning(FLERR,
                   "Fix mpm/contact {} heat: with scheme musl of fix mpm {}, contact takes energy "
                   "from the motion that does not become heat, up to 38 % in one case: use scheme "
                   "usl, or look at the entries contact and transfer of compute mpm/energy",
                   id, (*musl)->id());
}

bool FixMPMContact::couples(const std::string &a, const std::string &b) const
{
  return a != b && std::count(names.begin(), names.end(), a) &&
      std::count(names.begin(), names.end(), b);
}

bool FixMPMContact::touches(const std::string &name) const
{
  return std::count(names.begin(), names.end(), name) > 0;
}

bool FixMPMContact::decides_contact(const MPMField &field) const
{
  return touches(field.id());
}

bool FixMPMContact::has_law_of(const FixMPMContact &other) const
{
  const MPMContactLaw &law_of_other = other;
  return law_of_other == *this && normal_by == other.normal_by && gap == other.gap &&
      full == other.full;
}

/** Gives the heat of two bodies that slide to their nodes; returns it. */
double FixMPMContact::heat_of(const MPMNodeContact &pair, bool owned)
{
  const int dim = bodies.dim();
  double J[3], old[3], now[3];
  for (int d = 0; d < dim; d++) {
    J[d] = pair.left >> d & 1 ? 0.0 : pair.tangential[d];
    old[d] = pair.rb[4 + d] - pair.ra[4 + d];
    now[d] = pair.rb[d] - pair.ra[d];
    if (pair.alike) continue;
    const auto &a = pair.walls_a, &b = pair.walls_b;
    now[d] = b.velocity_of(pair.rb, d) - a.velocity_of(pair.ra, d);
    old[d] = (b.held >> d & 1 ? b.velocity[d] : pair.rb[4 + d]) -
        (a.held >> d & 1 ? a.velocity[d] : pair.ra[4 + d]);
  }
  const double heat = heating->made(J, old, now, dim);
  heating->between(pair.a, pair.ra, pair.b, pair.rb, pair.n, heat, owned);
  return heat;
}

/** Forces between bodies, work of the friction, and the ledgers of the fields. */
void FixMPMContact::count(const MPMContacts::Node &node, const MPMContactBodies::Velocities &start)
{
  for (int p = node.first; p < node.last; p++) {
    const MPMNodeContact &pair = contacts.pairs[p];
    if (pair.state == MPMNodeContact::OPEN) continue;
    const double heat = heating && pair.state == MPMNodeContact::SLIDING ? heat_of(pair, node.owned)
                                                                         : 0.0;
    if (!node.owned) continue;
    MPMContactReport::Entry &entry = report.of(pair.a, pair.b);
    double work = entry.add(pair, bodies.dim());
    if (heating) {    // the mean of old and new velocities, also for the ledger
      auto &ledger = bodies[pair.a].field->ledger;
      const double more = -heat - work * force->mvv2e;
      ledger.contact += more;
      ledger.transfer -= more;
      work = -heat / force->mvv2e;
    }
    entry.work += work;
    if (pair.bond) bodies[pair.a].field->ledger.driven += work * force->mvv2e;    // may come back
  }
  bodies.book(node.record, start);
}

/** Tells fields with smooth volumes which nodes do not move as their pressure would have them: all
 *  that touch, as round-off decides at some nodes at rest whether they approach. */
void FixMPMContact::bind_nodes()
{
  for (const auto &pair : contacts.pairs) {
    const auto &a = bodies[pair.a], &b = bodies[pair.b];
    if (a.field->smoothing) a.field->smoothing->bind(a.node_of(pair.ra));
    if (b.field->smoothing) b.field->smoothing->bind(b.node_of(pair.rb));
  }
}

void FixMPMContact::act(double dt, Stage stage)
{
  if (stage == TRIAL) return;
  if (stage != STEP) {
    if (!contacts.nodes.empty())
      for (auto &body : bodies.list) bodies.predict_walls(body);
    solver.solve(contacts, dt, true, {});
    return;
  }
  report.begin_step(dt);
  if (in_implicit_steps) {
    trial.act(report);
    return;
  }
  contacts.clear();
  if (search.begin_step()) {
    search.find(dt, contacts);
    if (heating) heating->begin_step();
  }
  if (interface) {
    const bool joins = !is_bonded;
    if (joins) interface->join(contacts, bonded);
    is_bonded = true;
    interface->find(contacts);
    if (joins) {
      const double area = interface->bonded_area(contacts);
      if (comm->me == 0)
        utils::logmesg(lmp, "Fix mpm/contact {}: bodies are bonded on an area of {:.6g}\n", id,
                       area);
    }
  }
  solver.solve(contacts, dt, false, [this](const auto &node, const auto &start) {
    count(node, start);
  });
  if (interface) interface->open(contacts, dt);
  bind_nodes();
  if (++steps % LOOK_EVERY == 1) {
    solver.report_unsolved(id);
    search.report_missed_water();
  }
}

void FixMPMContact::write_restart(FILE *fp)
{
  std::vector<double> total = {(double) size_array_rows, (double) is_bonded};
  for (int p = 0; p < size_array_rows; p++) {
    keep_totals(world, &report.entries[p].work, 1);
    total.push_back(report.entries[p].work);
  }
  if (comm->me) return;
  const std::string text = utils::join_words(names, " ");
  const std::string state =
      std::string((const char *) total.data(), total.size() * sizeof(double)) + text;
  write_state(fp, state.c_str(), state.size() + 1);
}

/** Rank 0 goes on with the totals. */
void FixMPMContact::restart(char *buf)
{
  const auto state = read_state(lmp, id, buf);
  const auto *const from = (const double *) state.data();
  if ((int) from[0] != size_array_rows)
    error->all(FLERR, Error::NOPOINTER,
               "Fix mpm/contact {} had another number of fields when the restart file was written: "
               "name as many, or give the fix another ID to begin anew",
               id);
  const std::size_t size = (2 + size_array_rows) * sizeof(double);
  if (state.size() <= size) refuse_state(lmp, id);
  const std::string ours = utils::join_words(names, " "),
                    theirs(state.data() + size, state.size() - size - 1);
  if (theirs != ours)
    error->all(FLERR, Error::NOPOINTER,
               "Fix mpm/contact {} was between {} when the restart file was written, not {}: name "
               "them in this order, or give the fix another ID to begin anew",
               id, theirs, ours);
  is_bonded = from[1] != 0.0;
  for (int p = 0; p < size_array_rows; p++)
    report.entries[p].work = comm->me == 0 ? from[2 + p] : 0.0;
}

double FixMPMContact::memory_usage()
{
  return FixMPMState::memory_usage() + (heating ? heating->memory_usage() : 0.0) +
      (interface ? interface->memory_usage() : 0.0) + bodies.memory_usage() +
      bytes_of(contacts.pairs, contacts.nodes);
}
