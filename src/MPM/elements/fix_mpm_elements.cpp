/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the MPM package, distributed under the terms of the
   GNU General Public License, version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "elements/fix_mpm_elements.h"

#include "elements/fix_mpm_elements_work.h"

#include "atom.h"
#include "base/mpm_clear.h"
#include "base/mpm_image.h"
#include "base/mpm_input.h"
#include "base/mpm_options.h"
#include "base/mpm_pair_styles.h"
#include "base/mpm_points.h"
#include "comm.h"
#include "domain.h"
#include "error.h"
#include "field/fix_mpm_material.h"
#include "field/mpm_field.h"
#include "field/mpm_time_limit.h"
#include "force.h"
#include "group.h"
#include "law/axes.h"
#include "material/batch.h"
#include "material/material.h"
#include "material/plane_stress.h"
#include "math/matrix.h"
#include "math_extra.h"
#include "mesh/bending.h"
#include "mesh/curved_surface.h"
#include "mesh/element.h"
#include "mesh/rims.h"
#include "mesh/shared_strain.h"
#include "mesh/triangle_gap.h"
#include "modify.h"
#include "neighbor.h"
#include "pair.h"
#include "update.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <numeric>

using namespace LAMMPS_NS;
using namespace MPM_NS;

/** The kernels of three dimensions serve two as well. */
static const BatchKernels &kernels()
{
  static const BatchKernels &all = *BatchKernels::select(3);
  return all;
}

static ElementType type_of(const double *row)
{
  return (ElementType) (int) row[1];
}
static bool bends(const double *row)
{
  return type_of(row) == ElementType::PATCH || type_of(row) == ElementType::CORNER ||
      type_of(row) == ElementType::EDGE;
}

// axes must have at least this part of their length along an element
static constexpr double LEAST_AXIS = 0.1;

// bending: error of a slope relative to the effect of the curvature, and share of triangles from which on a warning is due
static constexpr double ROUGH = 0.05, MANY_ROUGH = 0.1;

static const ElementRule &rule_of(const double *row)
{
  return ElementRule::of(type_of(row));
}

// number of nodes from which the owner of an element is chosen
static int number_of_corners(const MeshElement &element)
{
  return element.type == ElementType::PATCH ? 3 : element_nodes(element.type);
}

/* ----------------------------------------------------------------------
   fix ID group mpm/elements FILE keyword value ...
------------------------------------------------------------------------- */

Options MPMElementsOptions::declare(int dim)
{
  using namespace option;
  Options o("fix mpm/elements");
  o.argument(text(file, "file"));
  o.add("part",
        {text(part, "name", "name or tag of a physical group of the mesh, as in create_points")})
      .standard("all elements of the dimension of the simulation");
  o.add("locking", {word(fbar, {{"none", false}, {"fbar", true}})},
        "quantity that is averaged over an element to prevent volumetric locking");
  thin.declare(o, dim);
  o.add("compression", {word(compression, {{"yes", true}, {"no", false}})},
        "whether surfaces and lines resist compression (no: they wrinkle and sag)");
  o.add("bending", {word(bending, {{"no", NONE}, {"yes", CONSTANT}, {"linear", LINEAR}})},
        "whether surfaces of triangles, and lines, resist bending like elastic plates and rods; "
        "linear: with a curvature that changes within triangles");
  o.add("curved", {yes_no(curved)},
        "whether closed surfaces of triangles (2d: of lines) represent the curved surface through "
        "their nodes");
  o.add("axes",
        {numbers(axes, 6, "a1x a1y a1z a2x a2y a2z", ANY_NUMBER, "",
                 "axis 1 of the material, and a vector on the side of axis 2, on the undeformed "
                 "surface in 3d")})
      .then([this] {
        has_axes = true;
      })
      .standard("an isotropic material");
  o.refuse([this, dim] {
    auto rules = thin.rules();
    const char *const wrong = has_axes ? law::check_axes(axes, axes + 3) : nullptr;
    rules.push_back({curved && thin.dimension(dim) != dim - 1, "curved",
                     "is for closed surfaces: use thickness"});
    rules.push_back({has_axes && thin.dimension(dim) != 2, "axes",
                     "is for surfaces in 3d, which have a thickness"});
    rules.push_back({has_axes && (bending || !compression), "axes",
                     "is not for bending, nor for compression no, for which the material must be "
                     "isotropic"});
    rules.push_back({wrong != nullptr, "axes", "needs two vectors that are not parallel"});
    rules.push_back(
        {bending && !thin, "bending", "is for surfaces and lines: use thickness or section"});
    rules.push_back({bending == LINEAR && thin.dimension(dim) != 2, "bending",
                     "linear is for surfaces in 3d: use bending yes"});
    rules.push_back(
        {bending && !compression, "bending",
         "and compression no exclude each other: what wrinkles does not resist bending"});
    rules.push_back({!compression && !thin, "compression",
                     "no is for surfaces and lines: use thickness or section"});
    rules.push_back({fbar && thin, "locking", "fbar is for solids, not for surfaces and lines"});
    return rules;
  });
  return o;
}

FixMPMElements::FixMPMElements(LAMMPS *lmp, int narg, char **arg) :
    FixMPMState(lmp, narg, arg), dim(domain->dimension), points(MPMPoints::get(atom)),
    work(new Work)
{
  Options options = declare(dim);
  read_options(lmp, options, narg, arg, 3);
  along = thin.dimension(dim);
  if (!points)
    error->all(FLERR,
               "Fix mpm/elements requires material points: use atom_style mpm, or hybrid with mpm");
  if (!atom->tag_enable) error->all(FLERR, "Fix mpm/elements requires atom IDs");

  restart_global = 1;
  scalar_flag = vector_flag = 1;
  size_vector = 3;
  global_freq = 1;
  extscalar = extvector = 1;

  int maxpoint = 0;
  Mesh mesh = read_body(lmp, file, part, along, "Fix mpm/elements", 3);
  if (along == dim - 1) kind = mesh.orient_surface();
  nelements = mesh.elements.size();
  try {
    if (bending) mesh.add_bending();
  } catch (const std::runtime_error &e) {
    error->all(FLERR, "Fix mpm/elements bending: {}", e.what());
  }
  try {
    if (curved && !bending) add_edges(mesh, find_rims(mesh));
  } catch (const std::runtime_error &e) {
    error->all(FLERR, "Fix mpm/elements curved: {}", e.what());
  }
  if (curved && !kind.closed)
    error->all(FLERR,
               "Fix mpm/elements curved is for closed surfaces, and that of {} has a rim: use "
               "curved no",
               file);
  for (const auto &e : mesh.elements) {
    const auto &rule = ElementRule::of(e.type);
    maxnode = std::max(maxnode, rule.nnode);
    maxpoint = std::max(maxpoint, rule.npoint);
  }
  if (fbar && maxpoint == 1)
    error->all(FLERR,
               "Fix mpm/elements locking fbar is for quadrangles and hexahedra: elements with "
               "one integration point have no other volume to average with");

  // ghosts are found by their IDs

  if (atom->map_style == Atom::MAP_NONE) {
    atom->map_user = Atom::MAP_YES;
    atom->map_init();
    atom->map_set();
  }

  material = find_material();
  variables = names_of_history();
  nhistory = material->nhistory;
  stride = 2 + maxnode +
      std::max(maxnode * dim + maxpoint * point_size(),
               bending && along == 2 ? 1 + BentTriangle::size(bending == LINEAR) : 0) +
      (curved ? 1 : 0);
  width = 18 + nhistory;
  comm_reverse = width;
  work->history.resize((std::size_t) std::max(1, nhistory) * BATCH);
  if (thin) work->thin.resize(BATCH);
  define_plane_stress();
  state.declare(first, "mpm/elements:first");
  state.declare(count, "mpm/elements:count");
  make_elements(mesh);
  maxexchange = 1 + max_of_node * stride;
}

FixMPMElements::~FixMPMElements() = default;

/* ----------------------------------------------------------------------
   the material of the nodes must be that of the elements
------------------------------------------------------------------------- */

FixMPMMaterial *FixMPMElements::find_material() const
{
  const auto all = modify->get_fix_by_style("^mpm/material$");
  int mine = -1, index;
  for (int i = 0; i < atom->nlocal; i++)
    for (int k = 0; k < (int) all.size() && (atom->mask[i] & groupbit); k++)
      if (atom->mask[i] & all[k]->groupbit) mine = k;
  MPI_Allreduce(&mine, &index, 1, MPI_INT, MPI_MAX, world);
  if (index < 0)
    error->all(FLERR,
               "Fix mpm/elements {}: the points of group {} have no material: define a fix "
               "mpm/material for them before",
               id, group->names[igroup]);
  bigint other = 0, others;
  for (int i = 0; i < atom->nlocal; i++)
    other += (atom->mask[i] & groupbit) && !(atom->mask[i] & all[index]->groupbit);
  MPI_Allreduce(&other, &others, 1, MPI_LMP_BIGINT, MPI_SUM, world);
  if (others)
    error->all(FLERR,
               "Fix mpm/elements {}: the points of group {} must have one material: use a "
               "fix mpm/elements and a mesh for each",
               id, group->names[igroup]);
  return dynamic_cast<FixMPMMaterial *>(all[index]);
}

void FixMPMElements::define_plane_stress()
{
  if (material->material->is_of_surfaces() && !(thin && along == 2))
    error->all(
        FLERR, Error::NOLASTLINE,
        "Fix mpm/elements {}: the law of fix mpm/material {} bears nothing across a surface, "
        "and is for surfaces in 3d only: use thickness and axes",
        id, material->id);
  if (!thin) return;
  try {
    plane_stress.reset(new PlaneStress(*material->material, dim, along, compression, has_axes));
    if (bending) {
      const auto [E, ratio] = plane_stress->elastic_constants();
      const double t = thin.across();
      stiffness = along == dim - 1 ? E * t * t * t / (12.0 * (1.0 - ratio * ratio))
                                   : E * t * t / (4.0 * M_PI);
      nu = ratio;
    }
  } catch (const std::runtime_error &e) {
    error->all(
        FLERR, Error::NOLASTLINE,
        "Fix mpm/elements {}: the material of fix mpm/material {} cannot be that of {}: {}{}", id,
        material->id,
        bending           ? "what resists bending"
            : compression ? "surfaces or lines"
                          : "what does not resist compression",
        e.what(),
        along == 2 && !has_axes && !bending && compression
            ? ", or have its axes along the surface: use the keyword axes"
            : "");
  }
}

/** Gradients of the functions in the reference configuration; returns the volume of the point. */
double FixMPMElements::gradients(const ElementRule &rule, int q, const double (*x)[3],
                                 double (*g)[3]) const
{
  return thin ? thin.across() * rule.gradients_along(q, x, g) : rule.gradients(q, x, g);
}

/** Checks that no axis is almost normal to an element, where it would have no direction. */
void FixMPMElements::check_frame(const double (*frame)[3], bigint label) const
{
  double normal[3], size[3];
  for (int k = 0; k < 2; k++) size[k] = sqrt(dot(axes + 3 * k, axes + 3 * k));
  cross(axes, axes + 3, normal);
  size[2] = sqrt(dot(normal, normal));
  if (!(fabs(dot(frame[0], axes)) > LEAST_AXIS * size[0]) ||
      !(fabs(dot(frame[2], normal)) > LEAST_AXIS * size[2]))
    error->one(FLERR,
               "Fix mpm/elements {}: the axes are all but normal to element {} of the mesh, which "
               "gives them no direction there: give this part of the surface a mesh, or a part, of "
               "its own, with other axes",
               id, label);
}

std::string FixMPMElements::names_of_history() const
{
  std::string text;
  for (const auto &variable : material->material->history()) text += " " + variable.name;
  return text.empty() ? " none" : text;
}

/* ---------------------------------------------------------------------- */

FixMPMElements::IDs FixMPMElements::count_nodes() const
{
  IDs mine = {0, MAXTAGINT, 0}, all;
  for (int i = 0; i < atom->nlocal; i++) {
    if (!(atom->mask[i] & groupbit)) continue;
    mine.n++;
    mine.low = std::min(mine.low, atom->tag[i]);
    mine.high = std::max(mine.high, atom->tag[i]);
  }
  MPI_Allreduce(&mine.n, &all.n, 1, MPI_LMP_BIGINT, MPI_SUM, world);
  MPI_Allreduce(&mine.low, &all.low, 1, MPI_LMP_TAGINT, MPI_MIN, world);
  MPI_Allreduce(&mine.high, &all.high, 1, MPI_LMP_TAGINT, MPI_MAX, world);
  return all;
}

/* ----------------------------------------------------------------------
   elements from the mesh, whose nodes are the points of the group in order of their IDs; the
   reference configuration is where these are now
------------------------------------------------------------------------- */

void FixMPMElements::make_elements(const Mesh &mesh)
{
  const auto nnodes = (bigint) mesh.nodes.size();
  ids = count_nodes();
  if (ids.n != nnodes || (bigint) ids.high - ids.low + 1 != nnodes)
    error->all(FLERR,
               "Fix mpm/elements {}: group {} has {} atoms with IDs from {} to {}, the mesh has "
               "{} nodes: its group must be the points that one create_points ... mesh made from "
               "the same mesh",
               id, group->names[igroup], ids.n, ids.n ? ids.low : 0, ids.high, nnodes);

  std::vector<double> mine(3 * nnodes, 0.0), x(3 * nnodes);
  std::vector<int> local(nnodes, -1);
  for (int i = 0; i < atom->nlocal; i++) {
    if (!(atom->mask[i] & groupbit)) continue;
    const tagint k = atom->tag[i] - ids.low;
    local[k] = i;
    for (int d = 0; d < 3; d++) mine[3 * k + d] = atom->x[i][d];
  }
  MPI_Allreduce(mine.data(), x.data(), (int) (3 * nnodes), MPI_DOUBLE, MPI_SUM, world);

  // each element belongs to the node that owns fewest so far

  std::vector<int> owned(nnodes, 0);
  std::vector<std::pair<int, int>> here;    // (atom, element)
  for (int e = 0; e < (int) mesh.elements.size(); e++) {
    const auto &element = mesh.elements[e];
    int owner = element.node[0];
    for (int k = 1; k < number_of_corners(element); k++)
      if (owned[element.node[k]] < owned[owner]) owner = element.node[k];
    max_of_node = std::max(max_of_node, ++owned[owner]);
    if (local[owner] >= 0) here.emplace_back(local[owner], e);
  }
  std::vector<double> swells;
  if (curved)
    swells = curved_areas(dim, mesh, [&](int a, int b, double *to) {
      MathExtra::sub3(&x[3 * (std::size_t) b], &x[3 * (std::size_t) a], to);
      nearest_image(*domain, to);
    });
  std::sort(here.begin(), here.end());
  pool.assign(here.size() * stride, 0.0);
  double least = std::numeric_limits<double>::max(), volume[2] = {0.0, 0.0}, volumes[2];
  bigint rough = 0, all_rough;
  for (std::size_t k = 0; k < here.size(); k++) {
    const auto &element = mesh.elements[here[k].second];
    double *const r = row(k);
    r[0] = (double) element.label;
    r[1] = (double) static_cast<int>(element.type);
    const auto &rule = rule_of(r);
    double X[PATCH_NODES][3];
    for (int m = 0; m < rule.nnode; m++) {
      MathExtra::sub3(&x[3 * (std::size_t) element.node[m]], &x[3 * (std::size_t) element.node[0]],
                      X[m]);
      nearest_image(*domain, X[m]);
      r[2 + m] = (double) (ids.low + element.node[m]);
      for (int d = 0; d < dim && !bends(r); d++) r[2 + maxnode + m * dim + d] = X[m][d];
    }
    if (bends(r)) {
      define_bending(r, X, element.inside, rough);
      continue;
    }
    if (curved) r[stride - 1] = swells[here[k].second];
    double frequency = 0.0, size = 0.0;
    for (int q = 0; q < rule.npoint; q++) {
      double g[MAX_ELEMENT_NODES][3], frame[3][3];
      const double w = gradients(rule, q, X, g);
      if (has_axes) {
        find_frame(g, frame);
        check_frame(frame, (bigint) element.label);
      }
      if (!(w > 0.0))
        error->one(FLERR, "Fix mpm/elements {}: element {} of the mesh is inverted", id,
                   element.label);
      frequency += w * rule.nnode * rule.largest_eigenvalue(g);
      size += w;
      double at[3], *const s = state_of(r, q);
      for (int d = 0; d < 3; d++) {
        at[d] = x[3 * (std::size_t) element.node[0] + d];
        for (int m = 0; m < rule.nnode; m++) at[d] += rule.N[q][m] * X[m][d];
      }
      s[0] = s[4] = s[8] = 1.0;
      if (thin) find_motion(X, g, rule.nnode, motion_of(s));
      if (nhistory) material->material->initialize(at, s + 15);
    }
    volume[0] += size;
    least = std::min(least, 2.0 * sqrt(size / frequency));
  }
  MPI_Allreduce(&least, &shortest, 1, MPI_DOUBLE, MPI_MIN, world);
  MPI_Allreduce(&rough, &all_rough, 1, MPI_LMP_BIGINT, MPI_SUM, world);
  if (comm->me == 0 && (double) all_rough > MANY_ROUGH * (double) nelements)
    error->warning(FLERR,
                   "Fix mpm/elements {} bending: {} of {} triangles know too few nodes around them "
                   "to tell curvatures apart, and are too stiff: use a mesh whose inner nodes have "
                   "five to seven triangles each",
                   id, all_rough, nelements);

  // pressure of an equation of state

  for_batches(false, [&](Work &w) {
    material->material->initial_stress(w.batch);
    for (int p = 0; p < w.n; p++)
      for (int c = 0; c < 6; c++) w.state[p][9 + c] = w.batch.stress[c][p];
  });

  for (int i = 0; i < atom->nlocal; i++)
    if (atom->mask[i] & groupbit) volume[1] += atom->vfrac[i];
  MPI_Allreduce(volume, volumes, 2, MPI_DOUBLE, MPI_SUM, world);
  if (!modify->nfix_restart_peratom && !(fabs(volumes[0] - volumes[1]) <= 1.0e-6 * volumes[0]))
    error->all(
        FLERR,
        "Fix mpm/elements {}: the elements have a volume of {:.8g}, their nodes of {:.8g}: "
        "points that create_points ... mesh made must not be deformed before, and thickness or "
        "section must be the same",
        id, volumes[0], volumes[1]);

  keep_arrays();
  for (std::size_t k = 0; k < here.size(); k++)
    if (count[here[k].first]++ == 0.0) first[here[k].first] = (double) k;
}

/* ---------------------------------------------------------------------- */

void FixMPMElements::init()
{
  check_nodes();
  check_fields();
  has_lattice = field_of_nodes() != nullptr;
  warned_slack = false;
  pressure = nullptr;
  comm_reverse = width = 18 + nhistory;
  comm_forward = 3;

  // the fix mpm/material at the time of definition may have been removed or redefined since

  material = find_material();
  if (names_of_history() != variables)
    error->all(FLERR, Error::NOLASTLINE,
               "Fix mpm/elements {}: its elements have the history variables{}, but the present "
               "fix mpm/material {} of its points has{}: elements cannot go on with such a law, "
               "define this fix after their material",
               id, variables, material->id, names_of_history());

  define_plane_stress();
  if (bending) bending_frequency = largest_bending_frequency();

  // nodes of elements may be ghosts; elements that have stretched since need comm_modify

  const double extent =
      largest_extent();    // less than that of a pair style is a warning of LAMMPS
  if (!force->pair || extent > force->pair->cutforce + neighbor->skin)
    comm->cutghostuser = std::max(comm->cutghostuser, extent);
}

/* ----------------------------------------------------------------------
   the nodes must be those of the definition, and of no other mesh, whose forces would be added
------------------------------------------------------------------------- */

void FixMPMElements::check_nodes() const
{
  const IDs now = count_nodes();
  if (now.n != ids.n || now.low != ids.low || now.high != ids.high)
    error->all(
        FLERR, Error::NOLASTLINE,
        "Fix mpm/elements {}: group {} has {} atoms with IDs from {} to {}, but had {} from {} "
        "on: nodes of elements must not be added, deleted or renumbered; unfix it before",
        id, group->names[igroup], now.n, now.n ? now.low : 0, now.high, ids.n, ids.low);

  for (const auto *other : modify->get_fix_by_style("^mpm/elements$"))
    if (other != this && has_points_of(other->groupbit))
      error->all(FLERR, Error::NOLASTLINE,
                 "Fix mpm/elements {} and {} have points in common, which would feel the forces of "
                 "both: give them disjoint groups, or unfix one of them",
                 id, other->id);
}

bool FixMPMElements::has_points_of(int other_groupbit) const
{
  int mine = 0, any;
  for (int i = 0; i < atom->nlocal; i++)
    mine |= (atom->mask[i] & groupbit) && (atom->mask[i] & other_groupbit);
  MPI_Allreduce(&mine, &any, 1, MPI_INT, MPI_MAX, world);
  return any != 0;
}

const char *FixMPMElements::field_of_nodes() const
{
  for (const auto *field : MPMField::all(lmp))
    if (has_points_of(field->fix.groupbit)) return field->id();
  return nullptr;
}

std::vector<NearNodes::Edge> FixMPMElements::edges() const
{
  std::vector<NearNodes::Edge> mine;
  for (std::size_t e = 0; e < pool.size() / stride; e++) {
    const double *const r = row(e);
    if (bends(r)) continue;
    const double *const X = r + 2 + maxnode;
    const int nnode = rule_of(r).nnode;
    for (int k = 0; k < nnode; k++)
      for (int m = 0; m < k; m++) {
        double square = 0.0;
        for (int d = 0; d < dim; d++)
          square += (X[k * dim + d] - X[m * dim + d]) * (X[k * dim + d] - X[m * dim + d]);
        mine.push_back({(int64_t) r[2 + k] - ids.low, (int64_t) r[2 + m] - ids.low, sqrt(square)});
      }
  }

  return gather(mine);
}

/** Gathers the values of all ranks on all ranks, in the order of ranks. */
template <class T> std::vector<T> FixMPMElements::gather(const std::vector<T> &mine) const
{
  const int size = (int) (mine.size() * sizeof(T));
  std::vector<int> sizes(comm->nprocs), starts(comm->nprocs, 0);
  MPI_Allgather(&size, 1, MPI_INT, sizes.data(), 1, MPI_INT, world);
  for (int p = 1; p < comm->nprocs; p++) starts[p] = starts[p - 1] + sizes[p - 1];
  std::vector<T> all((starts.back() + sizes.back()) / sizeof(T));
  MPI_Allgatherv(mine.data(), size, MPI_BYTE, all.data(), sizes.data(), starts.data(), MPI_BYTE,
                 world);
  return all;
}

/* ---------------------------------------------------------------------- */

void FixMPMElements::check_fields() const
{
  for (const auto *field : MPMField::all(lmp)) {
    if (!has_points_of(field->fix.groupbit)) continue;
    const auto refuse = [&](bool broken, const std::string &what, const std::string &why) {
      if (broken)
        error->all(FLERR, "Fix mpm {} {} fix mpm/elements {}{}", field->id(), what, id, why);
    };
    const auto &given = field->options;
    refuse(given.locking != MPMFieldOptions::NO_CURE, "locking is not for nodes of elements: use",
           " locking fbar");
    refuse(given.bad == MPMFieldOptions::DELETE || given.delete_failed,
           "bad delete and failed delete cannot be used with",
           ", whose nodes must not be deleted: give them a fix mpm of their own");
    refuse(given.axisymmetric, "axisymmetric cannot be used with",
           ", whose elements are of plane strain: use create_points elements with shape cpdi2");
    refuse(given.every > 1, "every cannot be used with",
           ", which strains elements in each step: use every 1");
  }
}

/* ----------------------------------------------------------------------
   an upper bound for the distance of nodes of an element, with room for more deformation: the Frobenius
   norm of F is sqrt(dim) without deformation
------------------------------------------------------------------------- */

double FixMPMElements::largest_extent() const
{
  double largest = 0.0, widest = 0.0, most = 0.0, all;
  for (std::size_t e = 0; e < pool.size() / stride; e++) {
    double *const r = row(e);
    const auto &rule = rule_of(r);
    const double *const X = r + 2 + maxnode;
    double square = 0.0, stretch = 0.0;
    if (bends(r)) {
      widest = std::max(widest, extent_of(r));
      continue;
    }
    for (int k = 0; k < rule.nnode; k++)
      for (int j = 0; j < k; j++) {
        double s = 0.0;
        for (int d = 0; d < dim; d++)
          s += (X[k * dim + d] - X[j * dim + d]) * (X[k * dim + d] - X[j * dim + d]);
        square = std::max(square, s);
      }
    for (int q = 0; q < rule.npoint; q++) {
      double s = 0.0;
      const double *const F = state_of(r, q);
      for (int c = 0; c < (dim == 3 ? 9 : 5); c++) s += F[c] * F[c];
      stretch = std::max(stretch, s);
    }
    most = std::max(most, stretch);
    largest = std::max(largest, sqrt(square * stretch));
  }
  double mine[2] = {widest, most}, all_of[2];
  if (bending || curved) {
    MPI_Allreduce(mine, all_of, 2, MPI_DOUBLE, MPI_MAX, world);
    largest = std::max(largest, sqrt(all_of[0] * all_of[1]));
  }
  MPI_Allreduce(&largest, &all, 1, MPI_DOUBLE, MPI_MAX, world);
  return all;
}

/* ----------------------------------------------------------------------
   sorts rows in the order of atoms, and finds their nodes
------------------------------------------------------------------------- */

void FixMPMElements::find_nodes()
{
  const int nlocal = atom->nlocal;
  std::vector<double> sorted;
  sorted.reserve(pool.size());
  nodes.clear();
  for (int i = 0; i < nlocal; i++) {
    if (count[i] == 0) continue;
    const double *r = row(first[i]);
    first[i] = (double) nodes.size();
    sorted.insert(sorted.end(), r, r + (int) count[i] * stride);
    for (int k = 0; k < count[i]; k++, r += stride) {
      nodes.emplace_back();
      const int nnode = nodes_of(r);
      for (int m = 0; m < nnode; m++) {
        const int j = atom->map((tagint) r[2 + m]);
        if (j < 0)
          error->one(
              FLERR,
              "Fix mpm/elements {}: node {} of element {} is out of reach at step {}: "
              "it has left the box, or the element was stretched and needs a larger comm_modify "
              "cutoff than the present {:.6g}",
              id, (tagint) r[2 + m], (bigint) r[0], update->ntimestep, comm->get_comm_cutoff());
        nodes.back()[m] = domain->closest_image(i, j);
      }
    }
  }
  pool.swap(sorted);
}

/* ----------------------------------------------------------------------
   forces of the elements on their nodes, and means of their state for output
------------------------------------------------------------------------- */

void FixMPMElements::compute(bool starting)
{
  const int nlocal = atom->nlocal, nall = nlocal + atom->nghost;
  sums.assign((std::size_t) nall * width, 0.0);
  const auto strain = [&]() {
    for_batches(true, [&](Work &w) {
      material_update(w, starting);
      add_sums(w);
    });
  };
  if (has_lattice)
    strain();
  else
    keep_spent(strain);
  if (bending) add_bending();
  if (pressure) add_pressure(starting);
  comm->reverse_comm(this);

  clear_points(force_on, atom, 3);
  double **const f = atom->f;
  for (int i = 0; i < nlocal; i++) {
    if (!(atom->mask[i] & groupbit)) continue;
    const double *const s = &sums[(std::size_t) i * width], inverse = 1.0 / atom->vfrac[i];
    for (int d = 0; d < dim; d++) {
      force_on[3 * (std::size_t) i + d] = s[d];
      f[i][d] += s[d];
      if (!pressure) continue;
      f[i][d] += s[width - 3 + d];
      if (kind.closed) force_on[3 * (std::size_t) i + d] += s[width - 3 + d];
    }
    for (int c = 0; c < 9; c++) points->F[i][c] = inverse * s[3 + c];
    if (thin) {
      for (int c = 0; c < 9; c++) points->F[i][c] = 0.0;
      const double stretch = dim == 2 ? sqrt(inverse * s[3]) : cbrt(inverse * s[3]);
      for (int d = 0; d < 3; d++) points->F[i][4 * d] = d < dim ? stretch : 1.0;
    }
    for (int c = 0; c < 6; c++) points->tau[i][c] = inverse * s[12 + c];
    for (int k = 0; k < nhistory; k++) material->history[i][k] = inverse * s[18 + k];
  }
}

/* ----------------------------------------------------------------------
   visits all elements, as many at a time as fit into a batch
------------------------------------------------------------------------- */

template <class Visit> void FixMPMElements::for_batches(bool moved, Visit visit) const
{
  Work &w = *work;
  const auto flush = [&]() {
    if (w.n == 0) return;
    w.batch.n = w.n;
    w.batch.dt = update->dt;
    w.batch.h = shortest;
    w.batch.time = elapsed_time(*update);
    w.batch.history = reinterpret_cast<double(*)[BATCH]>(w.history.data());
    visit(w);
    w.n = 0;
    w.elements.clear();
  };
  w.n = 0;
  w.elements.clear();
  for (std::size_t e = 0; e < pool.size() / stride; e++) {
    if (bends(row(e))) continue;
    if (w.n + rule_of(row(e)).npoint > BATCH) flush();
    load(w, e, moved);
  }
  flush();
}

void FixMPMElements::for_trial_batches(const std::function<void(Work &)> &visit) const
{
  for_batches(true, visit);
}

int FixMPMElements::nodes_of(const double *r) const
{
  if (type_of(r) != ElementType::PATCH) return rule_of(r).nnode;
  BentTriangle bent;
  memcpy(&bent.n, bent_of(r), sizeof(bent.n));
  return bent.n;
}

/* ----------------------------------------------------------------------
   kinematics of an element: F = sum_k x_k grad_0 N_k, or the stored F if the element has not moved.
   F-bar (E.A. de Souza Neto et al., Int. J. Solids Struct. 33 (1996) 3277) replaces the J of each point by
   the mean of J over the element, in 2d by scaling the plane
------------------------------------------------------------------------- */

void FixMPMElements::load(Work &w, std::size_t e, bool moved) const
{
  double *const r = row(e);
  const auto &rule = rule_of(r);
  double X[MAX_ELEMENT_NODES][3], x[MAX_ELEMENT_NODES][3];
  for (int m = 0; m < rule.nnode; m++) {
    X[m][2] = 0.0;
    for (int d = 0; d < dim; d++) X[m][d] = r[2 + maxnode + m * dim + d];
    if (moved) MathExtra::sub3(atom->x[nodes[e][m]], atom->x[nodes[e][0]], x[m]);
    for (int d = 0; d < dim && trying; d++) {
      x[m][d] +=
          motion[3 * (std::size_t) nodes[e][m] + d] - motion[3 * (std::size_t) nodes[e][0] + d];
      if (m == shifted_node) x[m][d] += shift[d];
    }
  }

  double F[MAX_ELEMENT_POINTS][9], mean = 0.0, size = 0.0;
  w.elements.push_back({e, r, rule, w.n});
  for (int q = 0; q < rule.npoint; q++) {
    const int p = w.n + q;
    double g[MAX_ELEMENT_NODES][3];
    w.state[p] = state_of(r, q);
    w.volume[p] = swell_of(r) * gradients(rule, q, X, g);
    double *const f = F[q];
    if (thin && moved) {
      load_thin(w.thin[p], x, g, rule.nnode, w.state[p]);
      memcpy(w.g[p], g, sizeof(g));
      continue;
    }
    if (moved) {
      for (int a = 0; a < 3; a++)
        for (int b = 0; b < 3; b++) {
          f[3 * a + b] = a == b && a >= dim ? 1.0 : 0.0;
          for (int m = 0; m < rule.nnode && a < dim && b < dim; m++)
            f[3 * a + b] += x[m][a] * g[m][b];
        }
    } else {
      memcpy(f, w.state[p], 9 * sizeof(double));
    }
    const double J = w.J[p] = MPMPoints::det(f);
    if (!(J > 0.0) && trying)
      *trying = false;
    else if (!(J > 0.0))
      error->one(FLERR,
                 "Fix mpm/elements {}: element {} of the mesh has a deformation gradient of "
                 "determinant {} at step {}: use a smaller time step, a finer mesh, or elements of "
                 "better shape",
                 id, (bigint) r[0], J, update->ntimestep);
    mean += w.volume[p] * J;
    size += w.volume[p];
    const double inv = 1.0 / J;
    double inverse[9] = MPM_COFACTORS(f);    // transposed
    for (double &a : inverse) a *= inv;
    for (int m = 0; m < rule.nnode; m++)
      for (int a = 0; a < 3; a++) w.g[p][m][a] = dot(g[m], inverse + 3 * a);
  }

  Batch &b = w.batch;
  for (int q = 0; q < rule.npoint; q++) {
    const int p = w.n + q;
    double *const f = F[q];
    const double *const s = w.state[p];
    if (thin && moved) {    // find_stretches() completes it
      const double inv = 1.0 / MPMPoints::det(s);
      for (int c = 0; c < 6; c++) b.stress[c][p] = inv * s[9 + c];
      b.vol0[p] = w.volume[p];
      for (int k = 0; k < nhistory; k++) w.history[k * BATCH + p] = s[15 + k];
      continue;
    }
    b.J[p] = w.J[p];
    if (fbar && moved && rule.npoint > 1) {
      const double J = mean / size, scale = dim == 2 ? sqrt(J / w.J[p]) : cbrt(J / w.J[p]);
      for (int c = 0; c < (dim == 3 ? 9 : 5); c++) f[c] *= scale;
      b.J[p] = J;
    }
    const double Jold = MPMPoints::det(s), inv = 1.0 / Jold;
    b.Jold[p] = Jold;
    PlaneStress::Point point;
    if (has_axes) {
      double g[MAX_ELEMENT_NODES][3];
      gradients(rule, q, X, g);
      find_frame(g, point.frame);
    }
    double inverse[9] = MPM_COFACTORS(s), change[9];
    for (double &a : inverse) a *= inv;
    for (int c = 0; c < 9; c++) change[c] = f[c] - s[c];
    for (int i = 0; i < 3; i++)
      for (int j = 0; j < 3; j++) b.A[3 * i + j][p] = dot(change + 3 * i, inverse + 3 * j);
    if (has_axes) plane_stress->turn_to_material(point, f);
    for (int c = 0; c < 9; c++) b.F[c][p] = f[c];
    for (int c = 0; c < 6; c++) b.stress[c][p] = inv * s[9 + c];
    b.vol0[p] = w.volume[p];
    for (int k = 0; k < nhistory; k++) w.history[k * BATCH + p] = s[15 + k];
  }
  w.n += rule.npoint;
}

/** Finds axes for the motion along a surface or a line: those of the material, projected on the surface, if it has any. */
void FixMPMElements::find_frame(const double (*g)[3], double (*frame)[3]) const
{
  if (!has_axes) return plane_stress->make_frame(g[1], g[along], frame);
  double normal[3], flat[2][3];
  cross(g[1], g[2], normal);
  const double inv = 1.0 / dot(normal, normal);
  for (int k = 0; k < 2; k++) {
    const double part = inv * dot(normal, axes + 3 * k);
    for (int d = 0; d < 3; d++) flat[k][d] = axes[3 * k + d] - part * normal[d];
  }
  plane_stress->make_frame(flat[0], flat[1], frame);
}

/** Sets the motion along a surface or a line. */
void FixMPMElements::load_thin(PlaneStress::Point &point, const double (*x)[3],
                               const double (*g)[3], int nnode, const double *state) const
{
  find_frame(g, point.frame);
  find_motion(x, g, nnode, point.along);
  point.old = state;
}

/** Sets to = sum_k x_k grad N_k. */
void FixMPMElements::find_motion(const double (*x)[3], const double (*g)[3], int nnode,
                                 double *to) const
{
  std::fill_n(to, 9, 0.0);
  for (int m = 0; m < nnode; m++)
    for (int a = 0; a < dim; a++)
      for (int b = 0; b < dim; b++) to[3 * a + b] += x[m][a] * g[m][b];
}

/** Finds stress and deformation gradient of surfaces and lines. */
void FixMPMElements::find_stretches(Work &w)
{
  const int bad = plane_stress->update(w.batch, w.thin.data(), [this](Batch &b) {
    material->update_batch(b, kernels());
  });
  if (trying && bad >= 0) *trying = false;
  for (const auto &[number, row, rule, start] : w.elements)
    if (!trying && bad >= start && bad < start + rule.npoint)
      error->one(
          FLERR,
          "Fix mpm/elements {}: no state without stress across element {} was found at step {}: "
          "use a smaller time step, or a finer mesh",
          id, (bigint) row[0], update->ntimestep);
}

/* ----------------------------------------------------------------------
   stress and history of the points in the batch. At the start of a run, nothing has moved since the last
   evaluation of the stress, unless a command has moved points
------------------------------------------------------------------------- */

void FixMPMElements::material_update(Work &w, bool starting)
{
  Batch &b = w.batch;
  if (starting) {
    double largest = 0.0;
    for (int c = 0; c < 9; c++)
      for (int p = 0; p < w.n; p++)
        largest = std::max(largest,
                           fabs(thin ? w.thin[p].along[c] - motion_of(w.state[p])[c] : b.A[c][p]));
    if (largest < 1.0e-10) {
      if (thin) map_gradients(w);
      return;
    }
  }
  if (thin)
    find_stretches(w);
  else
    material->update_batch(b, kernels());
  for (int p = 0; p < w.n; p++) {
    double *const s = w.state[p];
    for (int c = 0; c < 9; c++) s[c] = b.F[c][p];
    for (int c = 0; c < 6; c++) s[9 + c] = b.J[p] * b.stress[c][p];
    for (int h = 0; h < nhistory; h++) s[15 + h] = w.history[h * BATCH + p];
    if (thin) std::copy_n(w.thin[p].along, 9, motion_of(s));
  }
  if (thin) map_gradients(w);
}

/** Maps gradients in the reference configuration to those in space. */
void FixMPMElements::map_gradients(Work &w)
{
  for (const auto &[number, row, rule, start] : w.elements)
    for (int p = start; p < start + rule.npoint; p++) {
      const double *const F = w.state[p];
      const double cofactors[9] = MPM_COFACTORS(F), inv = 1.0 / determinant(F);
      for (int m = 0; m < rule.nnode; m++) {
        double g[3];
        for (int a = 0; a < 3; a++) g[a] = inv * dot(w.g[p][m], cofactors + 3 * a);
        MathExtra::copy3(g, w.g[p][m]);
      }
    }
}

/* ----------------------------------------------------------------------
   f_k = -sum_q V0 tau grad N_k. With F-bar the power of the stress is tau : (L + (mean - tr L)/dim I)
   where mean is the rate of the mean of J. In the force, the mean of the pressure acts on the gradients of
   the volume of the element and replaces the pressure of each point: force and strain are consistent, and
   an elastic body keeps its energy
------------------------------------------------------------------------- */

/** Adds -f_k to f, in units of stress times volume over length. */
void FixMPMElements::find_forces(const Work &w, int start, const ElementRule &rule,
                                 double (*f)[3]) const
{
  const bool average = fbar && rule.npoint > 1;
  double volume = 0.0, pressure = 0.0;
  for (int q = 0; q < rule.npoint; q++) {
    const int p = start + q;
    const double *const s = w.state[p], V = w.volume[p];
    double t[6];
    for (int c = 0; c < 6; c++) t[c] = V * s[9 + c];
    if (average) {
      const double trace = (t[0] + t[1] + (dim == 3 ? t[2] : 0.0)) / dim;
      pressure += trace;
      for (int d = 0; d < dim; d++) t[d] -= trace;
      volume += V * w.J[p];
    }
    for (int m = 0; m < rule.nnode; m++) {
      const double *const g = w.g[p][m];
      f[m][0] += t[0] * g[0] + t[3] * g[1] + t[4] * g[2];
      f[m][1] += t[3] * g[0] + t[1] * g[1] + t[5] * g[2];
      f[m][2] += t[4] * g[0] + t[5] * g[1] + t[2] * g[2];
    }
  }
  for (int q = 0; q < rule.npoint && average; q++) {
    const double factor = pressure * w.volume[start + q] * w.J[start + q] / volume;
    for (int m = 0; m < rule.nnode; m++)
      for (int d = 0; d < dim; d++) f[m][d] += factor * w.g[start + q][m][d];
  }
}

/** Adds the forces of elements, and shares of their state, to the sums of their nodes. */
void FixMPMElements::add_sums(Work &w)
{
  const double scale = 1.0 / force->nktv2p;
  for (const auto &[number, row, rule, start] : w.elements) {
    double f[MAX_ELEMENT_NODES][3] = {{0.0}}, share[MAX_ELEMENT_NODES] = {0.0};
    double size = 0.0;
    w.mean.assign(15 + nhistory, 0.0);
    find_forces(w, start, rule, f);
    for (int q = 0; q < rule.npoint; q++) {
      const double V = w.volume[start + q] / swell_of(row);    // as for the masses of nodes
      for (int m = 0; m < rule.nnode; m++) share[m] += V * rule.N[q][m];
      size += V;
    }
    for (int q = 0; q < rule.npoint; q++) {
      const double *const s = w.state[start + q], weight = w.volume[start + q] / size;
      for (int c = 0; c < 15 + nhistory; c++) w.mean[c] += weight * s[c];
      // the elements of a fold are rotated by angles that have no mean
      if (thin) w.mean[0] += weight * (MPMPoints::det(s) - s[0]);
    }
    for (int m = 0; m < rule.nnode; m++) {
      double *const sum = &sums[(std::size_t) nodes[number][m] * width];
      for (int d = 0; d < dim; d++) sum[d] -= scale * f[m][d];
      for (int c = 0; c < 15 + nhistory; c++) sum[3 + c] += share[m] * w.mean[c];
    }
  }
}

/* ---------------------------------------------------------------------- */

void FixMPMElements::set_pressure(MPMElementsPressure *who, bool closed)
{
  if (along != dim - 1)
    error->all(FLERR, Error::NOLASTLINE,
               "Fix mpm/elements {} has no surface for a pressure: use the keyword thickness", id);
  if (pressure)
    error->all(FLERR, Error::NOLASTLINE, "Fix mpm/elements {} has more than one fix mpm/airbag",
               id);
  if (!kind.oriented)
    error->all(
        FLERR, Error::NOLASTLINE,
        "Fix mpm/elements {}: its surface has no two sides: more than two elements meet at an "
        "edge, or it is a Moebius strip",
        id);
  if (closed && !kind.closed)
    error->all(
        FLERR, Error::NOLASTLINE,
        "Fix mpm/elements {}: its surface has a rim, and encloses no gas: use a closed mesh, whose "
        "elements share their nodes, or fix mpm/airbag pressure",
        id);
  pressure = who;
  comm_reverse = width = 21 + nhistory;    // before LAMMPS makes room for messages
}

/* ----------------------------------------------------------------------
   visits triangles (for a quadrangle, both ways to divide it, with half a weight each) or lines: the positions of their
   nodes, without jumps at periodic faces
------------------------------------------------------------------------- */

template <class Visit> void FixMPMElements::for_faces(Visit visit) const
{
  for (int i = 0; i < atom->nlocal; i++) {
    double here[3];
    if (count[i] > 0) domain->unmap(atom->x[i], atom->image[i], here);
    for (int k = 0; k < count[i]; k++) {
      const auto e = (std::size_t) first[i] + k;
      if (bends(row(e))) continue;
      const int nnode = rule_of(row(e)).nnode;
      double x[4][3];
      for (int m = 0; m < nnode; m++)
        for (int d = 0; d < 3; d++) x[m][d] = here[d] + atom->x[nodes[e][m]][d] - atom->x[i][d];
      for (int part = 0; part < (nnode == 4 ? 4 : 1); part++) {
        const double *at[3];
        int node[3];
        for (int m = 0; m < std::min(3, nnode); m++) {
          at[m] = x[SPLIT[part][m]];
          node[m] = nodes[e][SPLIT[part][m]];
        }
        visit(nnode == 4 ? 0.5 : 1.0, at, node);
      }
    }
  }
}

std::vector<FixMPMElements::Face> FixMPMElements::faces() const
{
  std::vector<Face> all;
  for (std::size_t e = 0; e < nodes.size() && along == dim - 1; e++) {
    if (bends(row(e))) continue;
    const int nnode = rule_of(row(e)).nnode;
    for (int part = 0; part < (nnode == 4 ? 2 : 1); part++) {
      all.push_back({(bigint) row(e)[0], part, {}});
      for (int m = 0; m < std::min(3, nnode); m++) all.back().node[m] = nodes[e][SPLIT[part][m]];
    }
  }
  return all;
}

std::vector<FixMPMElements::NumberedFace> FixMPMElements::all_faces() const
{
  std::vector<NumberedFace> mine;
  for (int i = 0; i < atom->nlocal && along == dim - 1;
       i++)    // other rows may be from before a restart
    for (int k = 0; k < count[i]; k++) {
      const double *const r = row((std::size_t) first[i] + k);
      if (bends(r)) continue;
      const int nnode = rule_of(r).nnode;
      for (int part = 0; part < (nnode == 4 ? 2 : 1); part++) {
        mine.push_back({(bigint) r[0], part, {}});
        for (int m = 0; m < std::min(3, nnode); m++)
          mine.back().node[m] = (int64_t) r[2 + SPLIT[part][m]] - ids.low;
      }
    }
  return gather(mine);
}

/** Visits edges (in 2d: corners): the positions of their nodes, relative to the first one, and the edges. */
template <class Visit> void FixMPMElements::for_curved_edges(Visit visit) const
{
  for (std::size_t e = 0; e < nodes.size() && curved; e++) {
    if (type_of(row(e)) != ElementType::EDGE && type_of(row(e)) != ElementType::CORNER) continue;
    double x[4][3];
    for (int m = 0; m < nodes_of(row(e)); m++)
      MathExtra::sub3(atom->x[nodes[e][m]], atom->x[nodes[e][0]], x[m]);
    visit(x, nodes[e].data());
  }
}

double FixMPMElements::widest_gap() const
{
  double widest = 0.0, all;
  for_faces([&](double, const double *const at[3], const int *) {
    const auto side = [&](int a, int b) {
      double edge[3];
      MathExtra::sub3(at[a], at[b], edge);
      return sqrt(dot(edge, edge));
    };
    widest = std::max(
        widest, along == 1 ? 0.5 * side(0, 1) : triangle_gap(side(0, 1), side(1, 2), side(2, 0)));
  });
  MPI_Allreduce(&widest, &all, 1, MPI_DOUBLE, MPI_MAX, world);
  return all;
}

/* ----------------------------------------------------------------------
   p times the gradient of the enclosed volume: a third (in 2d half) of the area for each node, and the gradient of the volume
   between the triangles and a curved surface, so that the work is p dV exactly
------------------------------------------------------------------------- */

void FixMPMElements::add_pressure(bool starting)
{
  double mine[2] = {0.0, 0.0}, all[2];
  for_faces([&](double weight, const double *const at[3], const int *) {
    double normal[3];
    area_vector(dim, at, normal);
    mine[0] += weight * dot(normal, at[0]) / dim;
    mine[1] += weight * sqrt(dot(normal, normal));
  });
  for_curved_edges([&](const double(*x)[3], const int *) {
    mine[0] += curved_volume(dim, x, 1.0, nullptr);
  });
  MPI_Allreduce(mine, all, 2, MPI_DOUBLE, MPI_SUM, world);
  if (side == 0.0) side = kind.closed && all[0] < 0.0 ? -1.0 : 1.0;
  const double volume = kind.closed ? side * all[0] : 0.0;
  const double p = pressure->on_surface(volume, all[1], starting);
  if (!starting) pressure_work += 0.5 * (p + pressure_before) * (volume - volume_before);
  pressure_before = p;
  volume_before = volume;
  const double factor = side * p / (force->nktv2p * dim);
  for_faces([&](double weight, const double *const at[3], const int *node) {
    double normal[3];
    area_vector(dim, at, normal);
    for (int m = 0; m < dim; m++)
      for (int d = 0; d < dim; d++)
        sums[(std::size_t) node[m] * width + width - 3 + d] += weight * factor * normal[d];
  });
  for_curved_edges([&](const double(*x)[3], const int *node) {
    double gradient[4][3] = {{0.0}};
    curved_volume(dim, x, factor * dim, gradient);
    for (int m = 0; m <= dim; m++)
      for (int d = 0; d < dim; d++)
        sums[(std::size_t) node[m] * width + width - 3 + d] += gradient[m][d];
  });
}

/* ----------------------------------------------------------------------
   bending: a row stores the data of mesh/bending.h for the patch or corner
------------------------------------------------------------------------- */

void FixMPMElements::define_bending(double *r, const double (*X)[3], bool inside,
                                    bigint &rough) const
{
  double *const to = bent_of(r);
  double nodes_of_all[PATCH_NODES], square = 0.0;
  int slots[PATCH_NODES];
  std::iota(slots, slots + PATCH_NODES, 0);
  if (type_of(r) == ElementType::EDGE) {
    static_assert(sizeof(SharedStrain) <= sizeof(double) * BentTriangle::size(false),
                  "does not fit into a row");
    SharedStrain edge;
    edge.define(X);
    memcpy(to, &edge, sizeof(edge));
  } else if (type_of(r) == ElementType::PATCH) {
    static_assert(sizeof(BentTriangle) == sizeof(double) * BentTriangle::size(true),
                  "does not fit into a row");
    BentTriangle bent;
    bool has[PATCH_NODES - 3];
    for (int k = 0; k < PATCH_NODES - 3; k++) has[k] = r[2 + 3 + k] != r[2];
    rough += bent.define(X, has, inside, bending == LINEAR, slots) > ROUGH;
    memcpy(to, &bent, sizeof(double) * BentTriangle::size(bending == LINEAR));
    std::copy_n(r + 2, PATCH_NODES, nodes_of_all);
    for (int m = 0; m < bent.n; m++) r[2 + m] = nodes_of_all[slots[m]];
  } else {
    BentLine bent;
    bent.define(dim, X);
    if (dim == 3 && bent.rest > 1.0e-6)
      error->one(
          FLERR,
          "Fix mpm/elements {}: element {} of the mesh and the next one make an angle: bending "
          "is for lines that are straight when this fix is defined",
          id, (bigint) r[0]);
    memcpy(to, &bent, sizeof(bent));
  }
  const int nnode = nodes_of(r);
  for (int k = 0; k < nnode; k++)
    for (int m = 0; m < k; m++) {
      double s = 0.0;
      for (int d = 0; d < dim; d++) s += pow(X[slots[k]][d] - X[slots[m]][d], 2);
      square = std::max(square, s);
    }
  extent_of(r) = square;
}

BentTriangle FixMPMElements::bent_triangle(const double *r) const
{
  BentTriangle bent;
  memcpy(&bent, bent_of(r), sizeof(double) * BentTriangle::size(bending == LINEAR));
  return bent;
}

/** Energy of a row, and its forces on the nodes. */
double FixMPMElements::bend(const double *r, const double (*x)[3], double (*f)[3]) const
{
  const double *const from = bent_of(r);
  if (type_of(r) == ElementType::PATCH) { return bent_triangle(r).bend(stiffness, nu, x, f); }
  if (type_of(r) == ElementType::EDGE) {
    SharedStrain edge;
    memcpy(&edge, from, sizeof(edge));
    return edge.energy(12.0 * stiffness / (thin.across() * thin.across()), nu, x, f);
  }
  BentLine bent;
  memcpy(&bent, from, sizeof(bent));
  return bent.bend(stiffness, dim, x, f);
}

/** Calls visit(energy, row, number of nodes, forces on them) for all rows. */
template <class Visit> void FixMPMElements::for_bending(Visit visit) const
{
  for (std::size_t e = 0; e < nodes.size(); e++) {
    const double *const r = row(e);
    if (!bends(r)) continue;
    const int nnode = nodes_of(r);
    double x[PATCH_NODES][3], f[PATCH_NODES][3] = {{0.0}};
    for (int m = 0; m < nnode; m++)
      MathExtra::sub3(atom->x[nodes[e][m]], atom->x[nodes[e][0]], x[m]);
    const double energy = bend(r, x, f);
    visit(energy, e, nnode, f);
  }
}

void FixMPMElements::add_bending()
{
  const double scale = 1.0 / force->nktv2p;
  for_bending([&](double, std::size_t e, int nnode, const double(*f)[3]) {
    for (int m = 0; m < nnode; m++)
      for (int d = 0; d < dim; d++) sums[(std::size_t) nodes[e][m] * width + d] += scale * f[m][d];
  });
}

/** Largest frequency of free nodes, by the theorem of Gerschgorin: its square is at most the largest sum of a row of the stiffness
 *  over its mass. */
double FixMPMElements::largest_bending_frequency() const
{
  std::vector<double> sum(ids.n, 0.0), all(ids.n);
  for (std::size_t e = 0; e < pool.size() / stride; e++) {
    double *const r = row(e), mine[PATCH_NODES];
    if (!bends(r) || type_of(r) == ElementType::EDGE) continue;    // edges make nothing stiffer
    if (type_of(r) == ElementType::PATCH) {
      bent_triangle(r).stiffness_sums(nu, mine);
    } else {
      BentLine bent;
      memcpy(&bent, bent_of(r), sizeof(bent));
      bent.stiffness_sums(mine);
    }
    for (int m = 0; m < nodes_of(r); m++) sum[(bigint) r[2 + m] - ids.low] += stiffness * mine[m];
  }
  MPI_Allreduce(sum.data(), all.data(), (int) ids.n, MPI_DOUBLE, MPI_SUM, world);
  double largest = 0.0, square;
  for (int i = 0; i < atom->nlocal; i++)
    if (atom->mask[i] & groupbit)
      largest = std::max(largest, all[atom->tag[i] - ids.low] / atom->rmass[i]);
  MPI_Allreduce(&largest, &square, 1, MPI_DOUBLE, MPI_MAX, world);
  return sqrt(square * force->ftm2v / force->nktv2p);
}

/* ----------------------------------------------------------------------
   Energy that a body without a lattice spends is not in the balance of the lattices, which has neither its kinetic energy nor
   the forces that move it: the material returns it, and this fix keeps it
------------------------------------------------------------------------- */

void FixMPMElements::keep_spent(const std::function<void()> &strain)
{
  double work_before[NWORK];
  std::copy_n(material->work, (int) NWORK, work_before);
  const double stress_before = material->stress_work;
  strain();
  for (const int k : {MPM_NS::Work::PLASTIC, MPM_NS::Work::VISCOUS, MPM_NS::Work::FRACTURE})
    spent += material->work[k] - work_before[k];
  std::copy_n(work_before, (int) NWORK, material->work);
  material->stress_work = stress_before;
}

double FixMPMElements::compute_vector(int k)
{
  const double to_energy = 1.0 / force->nktv2p;
  if (k == 2) return pressure_work * to_energy;
  const double mine = k == 0 ? stored_energy() : spent;
  double all;
  MPI_Allreduce(&mine, &all, 1, MPI_DOUBLE, MPI_SUM, world);
  return (k == 0 ? all + pressure_work : all) * to_energy;
}

double FixMPMElements::stored_energy() const
{
  double sum = comm->me == 0 ? -pressure_work : 0.0, energy[BATCH];
  for_batches(false, [&](Work &w) {
    material->material->stored_energy(w.batch, energy);
    for (int p = 0; p < w.n; p++) sum += w.volume[p] * energy[p];
  });
  if (bending)
    for_bending([&](double stored, std::size_t, int, const double(*)[3]) {
      sum += stored;
    });
  return sum;
}

/* ----------------------------------------------------------------------
   The square of the highest frequency of an element with lumped masses rho_0 V_0/n at its n nodes
   and a stiffness of rho c^2 at most for any strain is n c^2 times the mean of the largest
   eigenvalue of sum_k grad N_k x grad N_k at most, and that of the body is not larger. The lattice
   can only lower it: its velocities are a part of those that nodes can have, and its lumped mass is
   not less than theirs. Bending and the gas add stiffness, so that squares add.
------------------------------------------------------------------------- */

double FixMPMElements::stable_dt(tagint &tag, double &speed) const
{
  constexpr double LITTLE_GAS =
      0.14;    // 1 % of the time step, less than what the bound has to spare
  double smallest = std::numeric_limits<double>::max(), c[BATCH];
  tag = 0;
  speed = 0.0;
  for_batches(false, [&](Work &w) {
    material->material->wave_speed(w.batch, c);
    for (const auto &[number, row, rule, start] : w.elements) {
      double sum = 0.0, size = 0.0, largest = 0.0;
      const double stiffer = swell_of(row);
      for (int q = 0; q < rule.npoint; q++) {
        const int p = start + q;
        sum += stiffer * w.volume[p] * c[p] * c[p] * rule.nnode * rule.largest_eigenvalue(w.g[p]);
        size += w.volume[p];
        largest = std::max(largest, c[p]);
      }
      const double dt = 2.0 * sqrt(size / sum);
      if (std::isnan(smallest) || dt >= smallest) continue;    // NaN does not pass unseen
      smallest = dt;
      tag = (tagint) row[2];
      speed = largest;
    }
  });
  const double gas = gas_frequency();
  if (tag == 0) return smallest;    // no elements here: other ranks know the limit
  const double others = hypot(2.0 / smallest, bending ? bending_frequency : 0.0);
  if (gas < LITTLE_GAS * others) return 2.0 / others;
  if (gas > others) speed = 0.0;
  return 2.0 / hypot(others, gas);
}

/* ----------------------------------------------------------------------
   The gas in a closed surface is one spring between all of its nodes, of the stiffness k = -dp/dV along the gradient g of the
   volume: omega^2 = k sum_i g_i^2/m_i. For a thin bag, the limit follows from the size of the bag, whatever its mesh. The
   pressure of this step may not be known yet
------------------------------------------------------------------------- */

double FixMPMElements::gas_frequency() const
{
  if (!pressure || !kind.closed || pressure->is_given()) return 0.0;
  auto &to = const_cast<FixMPMElements *>(this)->sent;
  to.assign(3 * ((std::size_t) atom->nlocal + atom->nghost), 0.0);
  double mine[2] = {0.0, 0.0}, all[2];
  for_faces([&](double weight, const double *const at[3], const int *node) {
    double normal[3];
    area_vector(dim, at, normal);
    mine[0] += weight * dot(normal, at[0]) / dim;
    for (int m = 0; m < dim; m++)
      for (int d = 0; d < dim; d++) to[3 * (std::size_t) node[m] + d] += weight * normal[d] / dim;
  });
  for_curved_edges([&](const double(*x)[3], const int *node) {
    double gradient[4][3] = {{0.0}};
    mine[0] += curved_volume(dim, x, 1.0, gradient);
    for (int m = 0; m <= dim; m++)
      for (int d = 0; d < dim; d++) to[3 * (std::size_t) node[m] + d] += gradient[m][d];
  });
  std::vector<double> gradient(3 * (std::size_t) atom->nlocal, 0.0);
  const_cast<FixMPMElements *>(this)->bring_home(gradient.data());
  for (int i = 0; i < atom->nlocal; i++)
    if (atom->mask[i] & groupbit) {
      const double *const g = &gradient[3 * (std::size_t) i];
      mine[1] += dot(g, g) / atom->rmass[i];
    }
  MPI_Allreduce(mine, all, 2, MPI_DOUBLE, MPI_SUM, world);
  const double square = pressure->stiffness(fabs(all[0])) * all[1];
  return sqrt(square * force->ftm2v / force->nktv2p);
}

/* ---------------------------------------------------------------------- */

void FixMPMElements::check_dt() const
{
  tagint tag;
  double speed;
  const double limit = stable_dt(tag, speed);
  if (update->dt <= limit) return;
  if (speed == 0.0)
    error->one(
        FLERR,
        "Time step {:.6g} is above the limit {:.6g} of fix mpm/elements {} at step {}, mostly by "
        "the stiffness of the gas in it (fix mpm/airbag): use timestep, or fix mpm/dt",
        update->dt, limit, id, update->ntimestep);
  error->one(FLERR,
             "Time step {:.6g} is above the limit {:.6g} of fix mpm/elements {} at step {}: "
             "element with node {}, wave speed {:.6g}; use timestep, fix mpm/dt, or a mesh without "
             "small elements",
             update->dt, limit, id, update->ntimestep, tag, speed);
}

/* ----------------------------------------------------------------------
   Where a slack element becomes taut its stiffness jumps, and Verlet steps that are not small then gain energy each time. A
   bag that unfolds has 1.29 of its energy after 4000 steps of 0.8 of the limit, 1.007 with half and 1.001 with a quarter of it
------------------------------------------------------------------------- */

void FixMPMElements::check_free_dt()
{
  constexpr double SLACK = 0.55;    // largest share of the limit without a warning
  check_dt();
  if (force->pair && update->setupflag)
    warn_of_points_as_grains(lmp, groupbit, fmt::format("Fix mpm/elements {}", id));
  if (compression || warned_slack) return;
  tagint tag;
  double speed, limit;
  const double mine = stable_dt(tag, speed);
  MPI_Allreduce(&mine, &limit, 1, MPI_DOUBLE, MPI_MIN, world);
  if (!(update->dt > SLACK * limit)) return;
  warned_slack = true;
  if (comm->me == 0)
    error->warning(
        FLERR,
        "Fix mpm/elements {}: slack elements without a lattice gain energy when they become taut "
        "with time steps above half of the limit, and this one is {:.2f} of it: use fix mpm/dt "
        "0.25",
        id, update->dt / limit);
}

/* ---------------------------------------------------------------------- */

double FixMPMElements::memory_usage()
{
  return FixMPMState::memory_usage() + (double) nodes.capacity() * sizeof(nodes[0]) +
      (double) (pool.capacity() + sums.capacity() + force_on.capacity() +
                work->history.capacity()) *
      sizeof(double);
}

/* ----------------------------------------------------------------------
   elements move with their atom. find_nodes() drops rows that no atom owns any more
------------------------------------------------------------------------- */

int FixMPMElements::pack_exchange(int i, double *buf)
{
  const int n = (int) count[i] * stride;
  buf[0] = count[i];
  if (n) std::copy_n(row(first[i]), n, buf + 1);
  return 1 + n;
}

int FixMPMElements::unpack_exchange(int i, double *buf)
{
  const int n = (int) buf[0] * stride;
  count[i] = buf[0];
  first[i] = (double) (pool.size() / stride);
  pool.insert(pool.end(), buf + 1, buf + 1 + n);
  return 1 + n;
}

void FixMPMElements::unpack_restart(int i, int nth)
{
  int n;
  const double *const values = from_restart(i, nth, n);
  if (n != 1 + (int) values[0] * stride)
    error->one(
        FLERR,
        "Fix mpm/elements {}: the restart file was written with another mesh or material, or with "
        "other values of bending or curved",
        id);
  unpack_exchange(i, const_cast<double *>(values));
}

/* ---------------------------------------------------------------------- */

void FixMPMElements::write_restart(FILE *fp)
{
  keep_totals(world, &spent, 1);
  if (comm->me) return;
  const double list[] = {shortest, pressure_work, spent};
  const int size = sizeof(list);
  fwrite(&size, sizeof(int), 1, fp);
  fwrite(list, sizeof(list), 1, fp);
}

void FixMPMElements::restart(char *buf)
{
  double list[3];
  memcpy(list, buf, sizeof(list));
  shortest = list[0];
  pressure_work = list[1];
  spent = comm->me == 0 ? list[2] : 0.0;
}

/* ---------------------------------------------------------------------- */

int FixMPMElements::pack_reverse_comm(int n, int start, double *buf)
{
  if (!sent.empty()) {    // see bring_home()
    std::copy_n(&sent[3 * (std::size_t) start], 3 * (std::size_t) n, buf);
    return 3 * n;
  }
  memcpy(buf, sums.data() + (std::size_t) start * width, sizeof(double) * n * width);
  return n * width;
}

void FixMPMElements::unpack_reverse_comm(int n, int *list, double *buf)
{
  for (int k = 0; k < n && !sent.empty(); k++)
    for (int d = 0; d < 3; d++) sent[3 * (std::size_t) list[k] + d] += *buf++;
  for (int k = 0; k < n && sent.empty(); k++) {
    double *const s = &sums[(std::size_t) list[k] * width];
    for (int c = 0; c < width; c++) s[c] += *buf++;
  }
}
