// SPDX-License-Identifier: Apache-2.0
#include "analysis/watertight.h"

#include "shaders_cpp/pixel/id_view.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <bit>
#include <cstdio>
#include <map>
#include <unordered_map>

namespace tessemu {

std::string_view name_of(Verdict verdict)
{
    return verdict == Verdict::Pass ? "pass" : verdict == Verdict::Fail ? "fail" : "skipped";
}

namespace {

constexpr std::size_t kPosition = 0, kNormal = 3, kDisplaced = 6;

/// A point of a shared edge, or a corner (b = a), as one patch has it.
struct Place {
    std::uint32_t a, b, t; ///< t in 1/65536 from a, the smaller vertex
    friend bool operator==(Place const&, Place const&) = default;
};
struct PlaceHash {
    std::size_t operator()(Place const& p) const
    {
        return ((std::size_t(p.a) * 0x9e3779b97f4a7c15u) ^ (std::size_t(p.b) << 20) ^ p.t) *
               0xbf58476d1ce4e5b9u;
    }
};
struct Seen {
    std::uint32_t face;
    std::array<std::uint32_t, 9> bits; ///< smooth position, normal, displaced position
    int patches = 1;                   ///< that have the point on their outline
};

glm::vec3 place_of(Seen const& s)
{
    glm::vec3 p;
    for (int k = 0; k < 3; ++k) p[k] = std::bit_cast<float>(s.bits[kDisplaced + std::size_t(k)]);
    return p;
}

// Points on the outline of a patch's triangles. With fractional_odd spacing and an inside factor of
// 1, points of inner rings lie on the patch's edges too (V18); those are inside the triangulation.
struct Outline {
    std::vector<char> on;
    std::vector<std::uint32_t> segments; ///< pairs of points
};
Outline outline_of(TessellatedPatch const& t)
{
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> triangles;
    for (std::size_t i = 0; i + 2 < t.indices.size(); i += 3)
        for (std::size_t k = 0; k < 3; ++k)
            ++triangles[std::minmax(t.indices[i + k], t.indices[i + (k + 1) % 3])];
    Outline out;
    out.on.assign(t.points(), 0);
    for (auto const& [edge, n] : triangles)
        if (n == 1) {
            out.on[edge.first] = out.on[edge.second] = 1;
            out.segments.insert(out.segments.end(), {edge.first, edge.second});
        }
    return out;
}

// Distance of two floats in units in the last place; large where they differ in sign.
std::uint64_t ulp_distance(std::uint32_t a, std::uint32_t b)
{
    auto const ordered = [](std::uint32_t x) {
        return x >> 31 ? -std::int64_t(x & 0x7fffffffu) : std::int64_t(x);
    };
    std::int64_t const d = ordered(a) - ordered(b);
    return std::uint64_t(d < 0 ? -d : d);
}

std::string hexadecimal(std::uint32_t bits)
{
    char text[16];
    std::snprintf(text, sizeof text, "0x%08x", bits);
    return text;
}

std::string place_in_words(CrackSite const& s)
{
    auto const number = [](std::uint32_t i) { return std::to_string(i + 1); };
    std::string const patches =
        "patches of faces " + number(s.face[0]) + " and " + number(s.face[1]);
    if (s.vertex[0] == s.vertex[1]) return patches + ", corner at vertex " + number(s.vertex[0]);
    return patches + ", edge " + number(s.vertex[0]) + "-" + number(s.vertex[1]) +
           ", t = " + std::to_string(s.t) + "/65536";
}

// The whole surface, and what meets at its shared edges.
class Surface {
public:
    Surface(Topology const& topology, PatchMesh const& patches, FrameSettings const& frame,
            bool keep_triangles, ThreadPool const& threads)
        : topology_(topology),
          displaced_(frame.displacement != nullptr)
    {
        visit_surface(patches, frame, threads, [&](DrawPass const& pass, ShadedPatch const& patch) {
            add(pass, patch, keep_triangles);
        });
    }

    std::unordered_map<Place, std::vector<Seen>, PlaceHash> const& places() const
    {
        return places_;
    }
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<std::uint32_t>> const&
    edges() const
    {
        return edges_;
    }
    RayMesh const& rays() const { return rays_; }
    std::vector<std::uint32_t> const& face_of_triangle() const { return face_of_triangle_; }
    std::vector<std::uint32_t> const& face_of_target() const { return face_of_target_; }

private:
    void add(DrawPass const& pass, ShadedPatch const& patch, bool keep_triangles)
    {
        PatchOrigin const& origin = pass.patches[patch.primitive_id];
        auto const face = topology_.mesh().face(origin.face);
        int const n = origin.sides;
        auto const vertex = [&](int i) { return face[std::size_t((i + origin.rotation) % n)]; };
        for (int k = 0; k < n; ++k)
            edges_[std::minmax(vertex(k), vertex(k + 1))].push_back(origin.face);
        TessellatedPatch const& tess = patch.points->patch;
        Outline& outline = outlines_[tess.indices];
        if (outline.on.empty()) outline = outline_of(tess);
        auto const component = [&](std::size_t k, std::size_t i) {
            return patch.outputs[k * patch.stride + i];
        };
        std::size_t const first_point = rays_.positions.size();
        if (keep_triangles) {
            auto const first = std::uint32_t(first_point);
            for (std::size_t i = 0; i < tess.points(); ++i)
                rays_.positions.emplace_back(component(0, i), component(1, i), component(2, i));
            rays_.control.insert(rays_.control.end(),
                                 rays_.positions.begin() + std::ptrdiff_t(first),
                                 rays_.positions.end());
            for (std::uint32_t i : tess.indices) rays_.triangles.push_back(first + i);
            face_of_triangle_.insert(face_of_triangle_.end(), tess.indices.size() / 3, origin.face);
            for (std::uint32_t i : outline.segments) rays_.targets.push_back(first + i);
            face_of_target_.insert(face_of_target_.end(), outline.segments.size() / 2, origin.face);
        }
        for (std::size_t i = 0; i < tess.points(); ++i) {
            if (!outline.on[i]) continue;
            std::uint32_t const u = tess.u[i], v = tess.v[i], one = kFixedOne;
            std::uint32_t const w = one - u - v;
            bool const quad = n == 4;
            bool const on[4] = {quad ? v == 0 : w == 0, quad ? u == one : u == 0,
                                quad ? v == one : v == 0, quad && u == 0};
            std::uint32_t const t[4] = {quad ? u : v, quad ? v : w, quad ? one - u : u, one - v};
            std::array<std::uint32_t, 9> bits;
            // Smooth position: behind the normal where the surface is displaced.
            std::size_t const from[9] = {
                displaced_ ? 7u : 0u, displaced_ ? 8u : 1u, displaced_ ? 9u : 2u, 4, 5, 6, 0, 1, 2};
            for (std::size_t c = 0; c < 9; ++c)
                bits[c] = std::bit_cast<std::uint32_t>(component(from[c], i));
            for (int k = 0; k < n; ++k) {
                if (!on[k]) continue;
                std::uint32_t a = vertex(k), b = vertex(k + 1), at = t[k];
                if (at == one) continue; // the next edge's first corner
                if (at == 0) {
                    b = a;
                } else if (a > b) {
                    std::swap(a, b);
                    at = one - at;
                }
                glm::vec3 const first = record({a, b, at}, {origin.face, bits, 1});
                if (keep_triangles) rays_.control[first_point + i] = first;
            }
        }
    }

    // Patches whose values are the same share an entry. Gives the point as the first patch has it.
    glm::vec3 record(Place const& place, Seen const& seen)
    {
        std::vector<Seen>& all = places_[place];
        auto const same = std::find_if(all.begin(), all.end(),
                                       [&](Seen const& s) { return s.bits == seen.bits; });
        if (same != all.end())
            ++same->patches;
        else
            all.push_back(seen);
        return place_of(all.front());
    }

    Topology const& topology_;
    bool displaced_;
    std::unordered_map<Place, std::vector<Seen>, PlaceHash> places_;
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<std::uint32_t>> edges_;
    std::map<std::vector<std::uint32_t>, Outline> outlines_;
    RayMesh rays_;
    std::vector<std::uint32_t> face_of_triangle_, face_of_target_;
};

class Checker {
public:
    Checker(Topology const& topology, PatchMesh const& patches, WatertightSettings const& settings,
            ThreadPool const& threads)
        : patches_(patches),
          s_(settings),
          threads_(threads),
          surface_(topology, patches, settings.frame, settings.rays > 0, threads)
    {
        for (auto const& [edge, faces] : surface_.edges())
            if (faces.size() == 1) ++open_edges_;
        for (auto const& [place, seen] : surface_.places()) order_.push_back(&place);
        std::sort(order_.begin(), order_.end(), [](Place const* x, Place const* y) {
            return std::tuple(x->a, x->b, x->t) < std::tuple(y->a, y->b, y->t);
        });
    }

    std::vector<CheckedVerdict> run()
    {
        std::vector<CheckedVerdict> out;
        auto const add = [&](CheckedVerdict verdict) {
            out.push_back(std::move(verdict));
            if (s_.progress) s_.progress(out.size() + 1, 7); // the tessellation was the first step
        };
        if (s_.progress) s_.progress(1, 7);
        add(topology());
        add(equal_bits("position", kPosition));
        add(equal_bits("normal", kNormal));
        add(displaced());
        add(coverage());
        add(raycast());
        return out;
    }

private:
    void add(CheckedVerdict& v, CrackSite site) const
    {
        v.verdict = Verdict::Fail;
        ++v.failures;
        if (v.sites.size() < s_.list) v.sites.push_back(std::move(site));
    }

    CheckedVerdict topology() const
    {
        CheckedVerdict v{"topology", Verdict::Pass, "", 0, 0, {}};
        for (Place const* p : order_) {
            if (p->a == p->b) continue;
            auto const& faces = surface_.edges().at({p->a, p->b});
            if (faces.size() != 2) continue;
            std::vector<Seen> const& seen = surface_.places().at(*p);
            int patches = 0;
            for (Seen const& s : seen) patches += s.patches;
            ++v.checked;
            if (patches == 2) continue;
            CrackSite site;
            site.face[0] = seen[0].face;
            site.face[1] = faces[0] == seen[0].face ? faces[1] : faces[0];
            site.vertex[0] = p->a, site.vertex[1] = p->b, site.t = p->t;
            site.place = place_of(seen[0]);
            site.text = place_in_words(site) + ": only the first has the point";
            add(v, site);
        }
        return v;
    }

    CheckedVerdict equal_bits(char const* name, std::size_t first) const
    {
        CheckedVerdict v{name, Verdict::Pass, "", 0, 0, {}};
        for (Place const* p : order_) {
            std::vector<Seen> const& seen = surface_.places().at(*p);
            int patches = 0;
            for (Seen const& s : seen) patches += s.patches;
            if (patches < 2) continue;
            ++v.checked;
            for (std::size_t i = 1; i < seen.size(); ++i) {
                std::size_t c = first;
                while (c < first + 3 && seen[i].bits[c] == seen[0].bits[c]) ++c;
                if (c == first + 3) continue;
                CrackSite site;
                site.face[0] = seen[0].face, site.face[1] = seen[i].face;
                site.vertex[0] = p->a, site.vertex[1] = p->b, site.t = p->t;
                site.component = int(c - first);
                site.bits[0] = seen[0].bits[c], site.bits[1] = seen[i].bits[c];
                site.ulp = ulp_distance(site.bits[0], site.bits[1]);
                site.place = place_of(seen[0]);
                site.text = place_in_words(site) + ": " + "xyz"[site.component] + " is " +
                            hexadecimal(site.bits[0]) + " and " + hexadecimal(site.bits[1]) + ", " +
                            std::to_string(site.ulp) + " ulp apart";
                add(v, site);
                break; // one failure a place
            }
        }
        return v;
    }

    CheckedVerdict displaced() const
    {
        if (s_.frame.displacement) return equal_bits("displaced", kDisplaced);
        return {"displaced", Verdict::Skipped, "the surface is not displaced", 0, 0, {}};
    }

    CheckedVerdict coverage() const
    {
        CheckedVerdict v{"coverage", Verdict::Pass, "", 0, 0, {}};
        if (open_edges_) {
            v.verdict = Verdict::Skipped;
            v.reason =
                "the surface is open: " + std::to_string(open_edges_) + " edges have one patch";
            return v;
        }
        PassSettings plain = pass_settings(s_.frame);
        plain.view_projection =
            view_projection(s_.frame.camera, float(s_.frame.width) / float(s_.frame.height));
        count_hits(plain, s_.frame.width, s_.frame.height, "", v);
        PassSettings rounded = plain;
        rounded.view_projection = view_projection(s_.frame.camera, 1);
        rounded.lattice = {kLattice, kLattice}; // half pixels
        count_hits(rounded, kLattice, kLattice, ", vertices rounded to half pixels", v);
        return v;
    }

    void count_hits(PassSettings const& settings, int width, int height, char const* what,
                    CheckedVerdict& v) const
    {
        CoverageCounts counts(width, height);
        RasterTarget raster;
        raster.viewports = {{0, 0, float(width), float(height), 0, 1}};
        raster.rasterizer.cull = CullMode::None;
        raster.rasterizer.front_counter_clockwise = true;
        raster.rasterizer.depth_clip_enable = false; // near and far plane hide nothing
        raster.coverage = &counts;
        raster.inclusive_edges = s_.frame.mistake.kind == Mistake::TopLeft;
        for (DrawPass const& pass : frame_passes(patches_, s_.frame, settings))
            draw_pass(pass, &raster, {}, threads_);
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x) {
                std::size_t const i = counts.index(x, y, 0);
                if (counts.count[i]) ++v.checked;
                if (counts.winding[i] == 0) continue;
                CrackSite site;
                site.pixel[0] = x, site.pixel[1] = y;
                site.hits = counts.winding[i];
                site.text = "pixel " + std::to_string(x) + ", " + std::to_string(y) + what + ": " +
                            std::to_string(counts.count[i]) + " hits, front less back " +
                            std::to_string(site.hits);
                if (*what) site.pixel[0] = site.pixel[1] = -1; // of another picture
                add(v, site);
            }
    }

    CheckedVerdict raycast() const
    {
        CheckedVerdict v{"raycast", Verdict::Skipped, "", 0, 0, {}};
        if (s_.rays == 0) {
            v.reason = "no rays were asked for";
            return v;
        }
        if (open_edges_) {
            v.reason =
                "the surface is open: " + std::to_string(open_edges_) + " edges have one patch";
            return v;
        }
        v.verdict = Verdict::Pass;
        std::uint64_t refuted = 0, folds = 0, past = 0, control = 0;
        for (RayAim aim : {RayAim::Segments, RayAim::Inside}) {
            RayCheck const c = check_rays(surface_.rays(), aim, s_.rays, s_.seed, threads_);
            v.checked += c.rays;
            refuted += c.refuted;
            folds += c.folds;
            past += c.past;
            control += c.control_misses;
            for (RayMiss const& m : c.confirmed) {
                CrackSite site;
                site.face[0] = site.face[1] = aim == RayAim::Segments
                                                  ? surface_.face_of_target()[m.triangle]
                                                  : surface_.face_of_triangle()[m.triangle];
                site.place = m.target;
                site.text = "a ray at the patch of face " + std::to_string(site.face[0] + 1) +
                            " slips through at " + std::to_string(m.target.x) + ", " +
                            std::to_string(m.target.y) + ", " + std::to_string(m.target.z) +
                            ": 113-bit arithmetic confirms it";
                add(v, site);
            }
        }
        std::uint64_t const confirmed = v.failures;
        std::string pictures;
        // Instances number their triangles, and points moved by parity are in the picture alone.
        if (!s_.frame.direct3d10 && s_.frame.parity == 0) {
            VisibilityCheck const c =
                check_visibility(surface_.rays(), surface_.face_of_triangle(), visible_faces(),
                                 s_.frame.camera, s_.frame.width, s_.frame.height, threads_);
            v.checked += c.pixels;
            for (auto const& pixel : c.unexplained) {
                CrackSite site;
                site.pixel[0] = pixel[0], site.pixel[1] = pixel[1];
                site.text = "pixel " + std::to_string(pixel[0]) + ", " + std::to_string(pixel[1]) +
                            ": the picture and Embree's first hit show other patches";
                add(v, site);
            }
            pictures = "; of " + std::to_string(c.pixels) + " pixels " +
                       std::to_string(c.edges + c.silhouettes + c.depths + c.unexplained.size()) +
                       " show another patch: " + std::to_string(c.edges) + " beside an edge, " +
                       std::to_string(c.silhouettes) + " at a silhouette, " +
                       std::to_string(c.depths) + " at equal depth, " +
                       std::to_string(c.unexplained.size()) + " unexplained";
        }
        v.reason = "Embree missed " + std::to_string(refuted + folds + past + confirmed) +
                   " rays: " + std::to_string(refuted) + " hit in 113-bit arithmetic, " +
                   std::to_string(folds) + " meet a fold that is closed, " + std::to_string(past) +
                   " pass the outline by a rounding; " + std::to_string(control) +
                   " missed on a control with equal edges" + pictures;
        return v;
    }

    /// The face that each pixel shows, -1 for none.
    std::vector<std::int64_t> visible_faces() const
    {
        int const width = s_.frame.width, height = s_.frame.height;
        ColorTarget color(width, height, Format::R32G32B32A32_FLOAT);
        DepthTarget depth(width, height, Format::D32_FLOAT);
        color.clear({-1, -1, -1, -1}, threads_);
        depth.clear(1, 0, threads_);
        RasterTarget raster{{&color}, &depth, {{0, 0, float(width), float(height), 0, 1}}};
        raster.rasterizer.cull = CullMode::None;
        PassSettings settings = pass_settings(s_.frame);
        settings.view_projection = view_projection(s_.frame.camera, float(width) / float(height));
        float number = 0;
        settings.pixel_shader = [&](PatchKind const&) {
            return make_pixel_program(IdPixelShader{number++}, s_.frame.machine);
        };
        std::vector<DrawPass> const passes = frame_passes(patches_, s_.frame, settings);
        for (DrawPass const& pass : passes) draw_pass(pass, &raster, {}, threads_);
        std::vector<std::int64_t> out;
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x) {
                auto const c = color.load(x, y);
                out.push_back(
                    c[0] < 0
                        ? -1
                        : std::int64_t(passes[std::size_t(c[1])].patches[std::size_t(c[0])].face));
            }
        return out;
    }

    static constexpr int kLattice = 256;
    PatchMesh const& patches_;
    WatertightSettings const& s_;
    ThreadPool const& threads_;
    Surface surface_;
    std::size_t open_edges_ = 0;
    std::vector<Place const*> order_;
};

} // namespace

PlantedMistake plant_mistake(Topology const& topology, Mistake kind)
{
    ControlMesh const& mesh = topology.mesh();
    for (std::uint32_t f = 0; f < mesh.faces(); ++f) {
        bool shared = true;
        for (HalfEdge h = mesh.face_start[f]; h < mesh.face_start[f + 1]; ++h)
            shared = shared && topology.twin(h) != Topology::kNone;
        if (shared) return {kind, f};
    }
    return {kind, 0};
}

std::vector<CheckedVerdict> check_watertight(Topology const& topology, PatchMesh const& patches,
                                             WatertightSettings const& settings,
                                             ThreadPool const& threads)
{
    WatertightSettings s = settings;
    // Mirror pairs are symmetric until products are fused.
    if (s.frame.mistake.kind == Mistake::Contraction)
        s.frame.machine.contraction = Contraction::All;
    return Checker(topology, patches, s, threads).run();
}

bool all_hold(std::vector<CheckedVerdict> const& verdicts)
{
    return std::none_of(verdicts.begin(), verdicts.end(),
                        [](CheckedVerdict const& v) { return v.verdict == Verdict::Fail; });
}

ColorTarget draw_cracks(PatchMesh const& patches, WatertightSettings const& settings,
                        std::vector<CheckedVerdict> const& verdicts, ThreadPool const& threads)
{
    FrameSettings s = settings.frame;
    s.view = View::Lit;
    Frame frame = draw_frame(patches, s, threads);
    Matrix4 const m = view_projection(s.camera, float(s.width) / float(s.height));
    auto const dot_at = [&](int px, int py) {
        for (int y = std::max(0, py - 1); y <= std::min(s.height - 1, py + 1); ++y)
            for (int x = std::max(0, px - 1); x <= std::min(s.width - 1, px + 1); ++x)
                encode(frame.color.format(), {0.9f, 0.05f, 0.05f, 1}, frame.color.texel(x, y));
    };
    for (CheckedVerdict const& v : verdicts)
        for (CrackSite const& site : v.sites) {
            if (site.pixel[0] >= 0) dot_at(site.pixel[0], site.pixel[1]);
            if (v.name == "coverage") continue;
            float4<float> const clip =
                transform(m, float3<float>(site.place.x, site.place.y, site.place.z));
            if (clip.w <= 0) continue;
            dot_at(int((clip.x / clip.w + 1) * float(s.width) / 2),
                   int((1 - clip.y / clip.w) * float(s.height) / 2));
        }
    return std::move(frame.color);
}

} // namespace tessemu
