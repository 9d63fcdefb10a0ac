// SPDX-License-Identifier: Apache-2.0
#include "pipeline/schemes/scheme.h"

#include "pipeline/mesh/join.h"
#include "pipeline/mesh/limit_points.h"
#include "pipeline/mesh/manifold.h"
#include "pipeline/mesh/sort_by_valence.h"
#include "pipeline/mesh/triangulate.h"

#include <algorithm>
#include <charconv>

namespace tessemu {

namespace {
// A scheme's file defines such a function; a line below declares and calls it.
using Make = std::unique_ptr<Scheme>();
} // namespace

std::vector<std::unique_ptr<Scheme>> const& schemes()
{
    static std::vector<std::unique_ptr<Scheme>> const all = [] {
        std::vector<std::unique_ptr<Scheme>> s;
        // clang-format off
        { Make make_gregory_stencil; s.push_back(make_gregory_stencil()); }
        { Make make_gregory_two_stage; s.push_back(make_gregory_two_stage()); }
        { Make make_acc; s.push_back(make_acc()); }
        { Make make_pm; s.push_back(make_pm()); }
        { Make make_stam; s.push_back(make_stam()); }
        { Make make_biseptic; s.push_back(make_biseptic()); }
        { Make make_bolz; s.push_back(make_bolz()); }
        { Make make_tables_catmull_clark; s.push_back(make_tables_catmull_clark()); }
        { Make make_tables_loop; s.push_back(make_tables_loop()); }
        { Make make_tables_butterfly; s.push_back(make_tables_butterfly()); }
        { Make make_qas; s.push_back(make_qas()); }
        { Make make_pn_triangles; s.push_back(make_pn_triangles()); }
        { Make make_phong; s.push_back(make_phong()); }
        { Make make_flat; s.push_back(make_flat()); }
        // clang-format on
        return s;
    }();
    return all;
}

Scheme const& find_scheme(std::string_view name)
{
    std::string known;
    for (auto const& s : schemes()) {
        if (s->info().name == name) return *s;
        known += (known.empty() ? "" : ", ") + s->info().name;
    }
    throw Error("scheme '" + std::string(name) + "' is not known; there is " + known);
}

void check_curvature(SchemeInfo const& info)
{
    if (info.no_curvature.empty()) return;
    std::string others;
    for (auto const& s : schemes())
        if (s->info().no_curvature.empty()) others += (others.empty() ? "" : ", ") + s->info().name;
    throw Error(info.name + " has no curvature to show: " + info.no_curvature +
                "; schemes that have it: " + others);
}

namespace {

std::string counted(std::size_t n, char const* one, char const* more)
{
    return std::to_string(n) + " " + (n == 1 ? one : more);
}

std::string in_words_of_steps(int steps)
{
    return std::to_string(steps) + (steps == 1 ? " step" : " steps") + " of subdivision";
}

} // namespace

std::string in_words(MeshRequirements const& t)
{
    std::string s = t.quads && t.triangles ? "quads and triangles"
                    : t.quads              ? "quads"
                                           : "triangles";
    auto const after = [](int steps) { return " after " + in_words_of_steps(steps); };
    if (t.steps) {
        s += "," + after(t.steps);
        int const with_triangles = t.steps_with_triangles.value_or(t.steps);
        if (t.triangles && with_triangles != t.steps)
            s += " (" + std::to_string(with_triangles) + " where a face is no quad)";
    } else if (t.quads && t.steps_with_polygons)
        s += ", larger faces" + after(t.steps_with_polygons);
    if (!t.boundary) s += ", closed meshes only";
    if (t.edges != t.kAnyNumber) s += ", at most " + std::to_string(t.edges) + " edges at a vertex";
    if (!t.creases && !t.corners)
        s += "; creases and corners are drawn smooth";
    else if (!t.creases || !t.corners)
        s += t.creases ? "; corners are drawn smooth" : "; creases are drawn smooth";
    return s;
}

namespace {

Parameters::Value parsed(SchemeInfo const& info, SchemeParameter const& p, std::string const& text)
{
    std::string const what = info.name + ": " + p.name + " is '" + text + "', it must be ";
    if (!p.words.empty()) {
        if (std::find(p.words.begin(), p.words.end(), text) != p.words.end()) return text;
        throw Error(what + in_words(p.words));
    }
    double x = 0;
    auto const [end, error] = std::from_chars(text.data(), text.data() + text.size(), x);
    if (error != std::errc() || end != text.data() + text.size()) throw Error(what + "a number");
    if (x >= p.min && x <= p.max) return x;
    auto const number = [](double d) {
        char digits[32];
        return std::string(digits, std::to_chars(digits, digits + sizeof digits, d).ptr);
    };
    throw Error(what + "a number from " + number(p.min) + " to " + number(p.max));
}

} // namespace

SchemeParameter const& sort_parameter()
{
    static SchemeParameter const sort{
        "sort", "order of vertices and faces for the tables", 0, 0, 0, {"none", "valence"}};
    return sort;
}

SchemeParameter const& coordinates_parameter()
{
    static SchemeParameter const coordinates{
        "coordinates",
        "texture coordinates that steps make: linear in faces, or by the masks of positions, with "
        "seams as boundaries",
        0,
        0,
        0,
        {"linear", "smooth"}};
    return coordinates;
}

Parameters resolve_parameters(SchemeInfo const& info, ParameterTexts const& given)
{
    Parameters out;
    std::string known;
    std::vector<SchemeParameter> all = info.parameters;
    all.push_back(sort_parameter());
    all.push_back(coordinates_parameter());
    for (SchemeParameter const& p : all) known += (known.empty() ? "" : ", ") + p.name;
    for (SchemeParameter const& p : info.parameters) {
        if (!p.words.empty())
            out.set(p.name, p.words[0]);
        else if (p.default_value)
            out.set(p.name, *p.default_value);
    }
    for (auto const& [name, text] : given) {
        auto const p = std::find_if(all.begin(), all.end(),
                                    [&, &n = name](auto const& q) -> bool { return q.name == n; });
        if (p == all.end())
            throw Error(info.name + " has no parameter '" + name + "'; there is " + known);
        auto const is_name = [&, &n = name](auto const& other) { return other.first == n; };
        if (std::count_if(given.begin(), given.end(), is_name) > 1)
            throw Error(info.name + ": '" + name + "' is set more than once");
        out.set(name, parsed(info, *p, text));
    }
    return out;
}

namespace {

// What requirements are about, of the file's mesh.
struct MeshFacts {
    std::size_t faces = 0, quads = 0, triangles = 0, polygons = 0; // of more than four sides
    std::uint32_t first_quad = 0, first_triangle = 0, first_polygon = 0;
    std::uint32_t boundary_face = 0, boundary_vertex = 0;
    bool boundary = false;
    // The most edges at a vertex, and the most sides of a face, which are edges of the vertex that
    // a step of subdivision puts into it.
    std::uint32_t edges = 0, edges_face = 0, edges_vertex = 0;
    std::uint32_t sides = 0, largest_face = 0;

    // The file's numbers.
    void name_as(ControlMesh const& mesh)
    {
        for (std::uint32_t* f : {&first_quad, &first_triangle, &first_polygon, &boundary_face,
                                 &edges_face, &largest_face})
            *f = mesh.file_face(*f);
        for (std::uint32_t* v : {&boundary_vertex, &edges_vertex}) *v = mesh.file_vertex(*v);
    }
};

MeshFacts facts_of(Topology const& topology)
{
    MeshFacts out;
    ControlMesh const& mesh = topology.mesh();
    out.faces = mesh.faces();
    for (std::uint32_t f = std::uint32_t(mesh.faces()); f-- > 0;) {
        auto const face = mesh.face(f);
        if (face.size() > 4) ++out.polygons, out.first_polygon = f;
        if (face.size() == 4) ++out.quads, out.first_quad = f;
        if (face.size() == 3) ++out.triangles, out.first_triangle = f;
        if (face.size() >= out.sides) out.sides = std::uint32_t(face.size()), out.largest_face = f;
        for (std::uint32_t v : face) {
            if (topology.is_boundary(v))
                out.boundary = true, out.boundary_face = f, out.boundary_vertex = v;
            if (std::uint32_t const n = topology.valence(v); n >= out.edges)
                out.edges = n, out.edges_face = f, out.edges_vertex = v;
        }
    }
    out.name_as(mesh);
    return out;
}

int steps_of(MeshRequirements const& t, MeshFacts const& m, int subdivide)
{
    return subdivide + (m.polygons    ? t.steps_with_polygons
                        : m.triangles ? t.steps_with_triangles.value_or(t.steps)
                                      : t.steps);
}

// \param cuts  faces into triangles where a scheme takes nothing else
bool takes(MeshRequirements const& t, MeshFacts const& m, int subdivide, bool cuts)
{
    if (m.boundary && !t.boundary) return false;
    if (m.edges > t.edges) return false;
    if (m.sides > t.edges && steps_of(t, m, subdivide) > 0) return false;
    if (cuts && !t.quads) return true;
    if (steps_of(t, m, subdivide) > 0 && t.quads) return true; // which it makes of all faces
    return !m.polygons && (t.quads || !m.quads) && (t.triangles || !m.triangles);
}

void refuse(SchemeInfo const& info, MeshFacts const& m, int subdivide, bool cuts)
{
    if (takes(info.takes, m, subdivide, cuts)) return;
    std::string others;
    for (auto const& s : schemes())
        if (takes(s->info().takes, m, subdivide, cuts))
            others += (others.empty() ? "" : ", ") + s->info().name;
    std::string const help = others.empty() ? "" : "; schemes that draw this mesh: " + others;
    auto const sides = [&](char const* good, char const* bad, std::size_t n, std::uint32_t first) {
        throw MeshError(first, info.name + " draws " + good + " only: " + std::to_string(n) +
                                   " of " + std::to_string(m.faces) + " faces are " + bad +
                                   ", the first is face " + std::to_string(first + 1) + help);
    };
    char const* const good = info.takes.quads ? "quads" : "triangles";
    if (steps_of(info.takes, m, subdivide) == 0 || !info.takes.quads) {
        if (!info.takes.triangles && m.triangles)
            sides(good, "triangles", m.triangles, m.first_triangle);
        if (!info.takes.quads && m.quads) sides(good, "quads", m.quads, m.first_quad);
        if (m.polygons) sides(good, "larger", m.polygons, m.first_polygon);
    }
    if (m.boundary && !info.takes.boundary)
        throw MeshError(m.boundary_face, info.name + " draws closed meshes only: face " +
                                             std::to_string(m.boundary_face + 1) + " has vertex " +
                                             std::to_string(m.boundary_vertex + 1) +
                                             " on the boundary" + help);
    std::string const most =
        info.name + " draws vertices of at most " + std::to_string(info.takes.edges) + " edges: ";
    if (m.edges > info.takes.edges)
        throw MeshError(m.edges_face, most + "vertex " + std::to_string(m.edges_vertex + 1) +
                                          " of face " + std::to_string(m.edges_face + 1) + " has " +
                                          std::to_string(m.edges) + help);
    throw MeshError(m.largest_face, most + "a step of subdivision makes one of " +
                                        std::to_string(m.sides) + " in face " +
                                        std::to_string(m.largest_face + 1) + help);
}

// "; bolz draws them", of the schemes that have a use for a tag.
std::string who_draws_them(bool MeshRequirements::*tag)
{
    std::string names;
    std::size_t count = 0;
    for (auto const& s : schemes())
        if (s->info().takes.*tag) names += (count++ ? ", " : "") + s->info().name;
    return count == 0 ? "" : "; " + names + (count == 1 ? " draws them" : " draw them");
}

// What the steps of subdivision leave to a scheme that has no use for it.
void warn_of_tags(SchemeInfo const& info, RefinedMesh const& refined, std::vector<std::string>& out)
{
    Topology const& topology = refined.base_topology();
    ControlMesh const& mesh = refined.base();
    LimitRules const* const rules = info.takes.step.limit;
    int const sharp_steps = rules && !rules->knows_tags ? 0 : refined.steps();
    std::string const after =
        sharp_steps ? " after " + in_words_of_steps(sharp_steps) : std::string();
    auto const is_left = [&](float sharpness) {
        return sharpness >= kInfinitelySharp || sharpness > float(sharp_steps);
    };
    // A crease on the boundary is sharp by nature.
    auto const is_inside = [](Topology const& t, ControlMesh::Crease const& c) {
        HalfEdge const h = t.find_edge(c.a, c.b);
        return h != Topology::kNone && t.twin(h) != Topology::kNone;
    };
    auto creases =
        std::count_if(mesh.creases.begin(), mesh.creases.end(), [&](ControlMesh::Crease const& c) {
            return is_left(c.sharpness) && is_inside(topology, c);
        });
    if (creases == 0 &&
        mesh.rules.crease_method == CreaseMethod::Chaikin) // sharper ones lend it some
        creases = std::any_of(
            refined.mesh().creases.begin(), refined.mesh().creases.end(),
            [&](ControlMesh::Crease const& c) { return is_inside(refined.topology(), c); });
    if (creases && !info.takes.creases)
        out.push_back(counted(std::size_t(creases), "crease edge is", "crease edges are") +
                      " drawn smooth" + after + ": the scheme knows no creases" +
                      who_draws_them(&MeshRequirements::creases));
    auto const corners =
        std::count_if(mesh.corners.begin(), mesh.corners.end(),
                      [&](ControlMesh::Corner const& c) { return is_left(c.sharpness); });
    if (corners && !info.takes.corners)
        out.push_back(counted(std::size_t(corners), "sharp corner is", "sharp corners are") +
                      " drawn smooth" + after + ": the scheme knows no corners" +
                      who_draws_them(&MeshRequirements::corners));
    ControlMesh const& drawn = refined.mesh();
    bool triangles = false;
    for (std::size_t f = 0; f < drawn.faces() && !triangles; ++f)
        triangles = drawn.face(f).size() == 3;
    if (drawn.rules.smooth_triangles && triangles && !info.takes.step.keeps_triangles)
        out.push_back("triangles are drawn without the weights of smoothtriangles: a step of "
                      "subdivision has them");
}

void warn(SchemeOnMesh& out, BuildOptions const& options, std::vector<std::string> const& warnings)
{
    for (std::string const& w : warnings) {
        out.warnings.push_back(w);
        if (options.warn) options.warn(w);
    }
}

// Whether to sort; what there is to sort for is tables.
bool resolve_sort(SchemeInfo const& info, int steps, Parameters& parameters)
{
    SchemeParameter const& sort = sort_parameter();
    bool const is_given = parameters.values().count(sort.name) > 0;
    if (steps == 0 && is_given && parameters.word(sort.name) != sort.words[0])
        throw Error(info.name + ": " + sort.name + " is '" + parameters.word(sort.name) +
                    "', and no step of subdivision is taken whose tables it would sort");
    if (info.takes.step.keeps_triangles && is_given && parameters.word(sort.name) != sort.words[0])
        throw Error(info.name + ": " + sort.name + " is '" + parameters.word(sort.name) +
                    "', which sorts the tables of Catmull-Clark subdivision alone");
    if (steps == 0) return false;
    if (!is_given) parameters.set(sort.name, sort.words[0]);
    return parameters.word(sort.name) != sort.words[0];
}

bool resolve_coordinates(SchemeInfo const& info, ControlMesh const& mesh, int steps,
                         Parameters const& parameters)
{
    SchemeParameter const& p = coordinates_parameter();
    if (!parameters.values().count(p.name) || parameters.word(p.name) == p.words[0]) return false;
    std::string const what = info.name + ": " + p.name + " is '" + parameters.word(p.name) + "', ";
    if (steps == 0)
        throw Error(what +
                    "and no step of subdivision is taken that would make some (--subdivide)");
    if (mesh.face_coordinates.empty())
        throw Error(what + "and the mesh has no texture coordinates");
    return true;
}

// What the scheme takes is refined, anything else refused or, unless it must be taken, refined too.
// Without a scheme the mesh's rules stay what they are.
SchemeOnMesh refine(SchemeInfo const& info, Scheme const* scheme, ControlMesh mesh,
                    BuildOptions const& options, bool must_be_taken)
{
    constexpr int kMost = 6;
    if (options.subdivide < 0)
        throw Error("steps of subdivision is " + std::to_string(options.subdivide) +
                    ", it must be 0 or more");
    if (options.subdivide > kMost)
        throw LimitError("steps of subdivision", std::uint64_t(options.subdivide), kMost);
    SchemeOnMesh out;
    out.parameters = resolve_parameters(info, options.set);
    if (options.join) {
        JoinedMesh joined = join_vertices(std::move(mesh), *options.join, options.placement);
        mesh = std::move(joined.mesh);
        warn(out, options, in_words(joined.join, *options.join));
    }
    if (!options.strict) {
        ManifoldMesh manifold = make_manifold(std::move(mesh));
        mesh = std::move(manifold.mesh);
        warn(out, options, in_words(manifold.repairs, options.lines));
    }
    if (scheme)
        scheme->set_rules(mesh, out.parameters,
                          [&](std::string const& w) { warn(out, options, {w}); });
    if (!info.takes.quads && (!options.strict || !must_be_taken)) {
        TriangulatedMesh cut = triangulate(std::move(mesh));
        mesh = std::move(cut.mesh);
        if (cut.cut_faces)
            warn(out, options,
                 {counted(cut.cut_faces, "face is", "faces are") +
                  " cut into triangles by diagonals from the first vertex, for " + info.name +
                  " draws nothing else: the first is face " + std::to_string(cut.first_cut + 1)});
    }
    MeshFacts sides;
    for (std::size_t f = 0; f < mesh.faces(); ++f) {
        std::size_t const n = mesh.face(f).size();
        sides.sides = std::max(sides.sides, std::uint32_t(n));
        sides.polygons += n > 4;
        sides.triangles += n == 3;
    }
    int const own = steps_of(info.takes, sides, 0),
              more = scheme ? scheme->more_steps(out.parameters) : 0,
              steps = own + options.subdivide + more;
    bool const sorts = resolve_sort(info, steps, out.parameters);
    mesh.rules.smooth_coordinates = resolve_coordinates(info, mesh, steps, out.parameters);
    if (must_be_taken) // before the work
        refuse(info, facts_of(Topology(mesh)), options.subdivide, !options.strict);
    if (sorts) mesh = sort_by_valence(mesh, info.takes.step(Topology(mesh)).tables);
    out.mesh = std::make_shared<RefinedMesh const>(std::move(mesh), steps, info.takes.step,
                                                   options.progress);
    RefinedMesh const& refined = *out.mesh;
    if (sides.polygons && own > 0)
        warn(out, options,
             {counted(sides.polygons, "face has", "faces have") + " more than 4 sides (up to " +
              std::to_string(sides.sides) + "): " +
              (own == 1 ? "one Catmull-Clark step makes "
                        : std::to_string(own) + " Catmull-Clark steps make ") +
              std::to_string(refined.base().face_vertices.size() << 2 * (own - 1)) +
              " quads of the mesh's " + std::to_string(refined.base().faces()) + " faces"});
    return out;
}

} // namespace

SchemeOnMesh refine_for_scheme(Scheme const& scheme, ControlMesh mesh, BuildOptions const& options)
{
    return refine(scheme.info(), &scheme, std::move(mesh), options, false);
}

SchemeOnMesh refine_for_no_scheme(RefinementStep step, ControlMesh mesh,
                                  BuildOptions const& options)
{
    SchemeInfo none;
    none.name = "subdivide";
    none.takes.steps_with_polygons = 0;
    none.takes.step = step;
    none.takes.quads = !step.keeps_triangles;
    return refine(none, nullptr, std::move(mesh), options, false);
}

SchemeOnMesh build_scheme(Scheme const& scheme, ControlMesh mesh, BuildOptions const& options)
{
    SchemeInfo const info = scheme.info();
    SchemeOnMesh out = refine(info, &scheme, std::move(mesh), options, true);
    out.patches = scheme.build(out.mesh, out.parameters,
                               {options.tables, options.warn, options.progress, options.threads});
    std::vector<std::string> more;
    if (auto const other = out.patches->another_way()) {
        if (options.strict)
            throw MeshError(other->face, other->what +
                                             ", which --strict refuses: the first is of face " +
                                             std::to_string(other->face + 1));
        more.push_back(other->what);
    }
    for (std::string const& w : out.patches->warnings()) more.push_back(w);
    if (out.patches->patch_counts().empty())
        more.push_back("no face is drawn: all are holes, or hidden at the boundary");
    warn_of_tags(info, *out.mesh, more);
    warn(out, options, more);
    return out;
}

} // namespace tessemu
