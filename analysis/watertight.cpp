// SPDX-License-Identifier: Apache-2.0
#include "analysis/watertight.h"

#include "analysis/moved_points.h"
#include "analysis/shared_edges.h"
#include "pipeline/mesh/join.h"
#include "shaders_cpp/pixel/id_view.h"

#include <glm/common.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdio>
#include <map>

namespace tessemu {

std::string_view name_of(Verdict verdict)
{
    return verdict == Verdict::Pass ? "pass" : verdict == Verdict::Fail ? "fail" : "skipped";
}

namespace {

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

std::string with_article(std::string const& noun)
{
    return (std::string_view("aeiou").find(noun[0]) < 5 ? "an " : "a ") + noun;
}

// Where a site lies: its patches and its point.
void set_place(CrackSite& site, ControlMesh const& mesh, MeshPoint const& at, std::uint32_t face,
               std::uint32_t other, std::string const& edge = "")
{
    MeshPoint const p = as_in_file(mesh, at);
    site.face[0] = mesh.file_face(face);
    site.face[1] = mesh.file_face(other);
    if (p.kind != MeshPoint::Kind::Face)
        site.vertex[0] = p.a, site.vertex[1] = p.kind == MeshPoint::Kind::Edge ? p.b : p.a;
    site.t = p.kind == MeshPoint::Kind::Edge ? p.t >> 9 : 0;
    site.text = "patches of faces " + std::to_string(site.face[0] + 1) + " and " +
                std::to_string(site.face[1] + 1) + ", " + in_words(p) +
                (edge.empty() ? "" : ", on " + with_article(edge));
    site.edge = edge;
}

class Checker {
public:
    Checker(PatchMesh const& patches, WatertightSettings const& settings, ThreadPool const& threads)
        : patches_(patches),
          mesh_(patches.mesh().base()),
          s_(settings),
          threads_(threads),
          surface_(patches, settings.frame, settings.rays > 0, threads),
          open_edges_(surface_.open_edges()),
          shared_edges_(surface_.shared_edges()),
          seams_(find_seams(patches.mesh().base_topology()))
    {
        for (auto const& [point, seen] : surface_.points()) order_.push_back(&point);
        std::sort(order_.begin(), order_.end(),
                  [](MeshPoint const* x, MeshPoint const* y) { return *x < *y; });
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
        add(equal_bits("position", SeenPoint::kPosition));
        add(equal_bits("normal", SeenPoint::kNormal));
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

    static std::string both(std::string const& a, std::string const& b)
    {
        return a.empty() || b.empty() ? a + b : a + "; " + b;
    }
    static std::string counted(std::size_t n, char const* one, char const* many)
    {
        return n == 1 ? std::string("1 ") + one : std::to_string(n) + " " + many;
    }

    // Edges of the file that look shared and are not.
    std::string seams() const
    {
        if (seams_.edges == 0) return "";
        return counted(seams_.edges, "open edge of the mesh lies", "open edges of the mesh lie") +
               " on others with other vertices";
    }
    std::string not_compared() const
    {
        std::uint32_t const n = mesh_.cut_edges;
        return both(n ? counted(n, "cut edge is not compared", "cut edges are not compared") : "",
                    seams());
    }
    std::string is_open() const
    {
        return both("the surface is open: " +
                        counted(open_edges_, "edge has one patch", "edges have one patch"),
                    seams());
    }

    static void skip(CheckedVerdict& v, std::string reason)
    {
        v.verdict = Verdict::Skipped;
        v.reason = std::move(reason);
    }
    // Nothing passes where nothing was checked.
    CheckedVerdict settled(CheckedVerdict v, std::string const& nothing) const
    {
        if (v.verdict == Verdict::Pass && v.checked == 0) skip(v, both(nothing, v.reason));
        return v;
    }
    std::string nothing_shared() const { return "no two patches share an edge"; }

    // A point inside two patches' edges must be a point of both: otherwise one passes it by.
    CheckedVerdict topology() const
    {
        CheckedVerdict v{"topology", Verdict::Pass, not_compared(), 0, 0, {}};
        for (auto const& [name, line] : surface_.lines()) {
            std::vector<SharedEdges::OnLine> at = line.points;
            std::stable_sort(at.begin(), at.end(), [](auto const& x, auto const& y) {
                return std::pair(x.t, x.patch) < std::pair(y.t, y.patch);
            });
            for (std::size_t i = 0, end = 0; i < at.size(); i = end) {
                while (end < at.size() && at[end].t == at[i].t) ++end;
                std::vector<std::uint32_t> inside; // patches whose edge has the point inside
                for (SharedEdges::Interval const& interval : line.intervals)
                    if (interval.low < at[i].t && at[i].t < interval.high)
                        inside.push_back(interval.patch);
                if (inside.empty()) continue; // where edges end
                bool const alone = inside.size() == 1 && end - i == 1;
                if (alone) continue; // the boundary
                ++v.checked;
                for (std::uint32_t patch : inside) {
                    auto const first = at.begin() + std::ptrdiff_t(i),
                               last = at.begin() + std::ptrdiff_t(end);
                    if (std::any_of(first, last, [&](auto const& p) { return p.patch == patch; }))
                        continue;
                    CrackSite site;
                    set_place(site, mesh_, at[i].point, surface_.face_of_patch(at[i].patch),
                              surface_.face_of_patch(patch));
                    site.place = surface_.points().at(at[i].point)[0].displaced();
                    site.text += ": only the first has the point";
                    add(v, site);
                }
            }
        }
        return settled(std::move(v), shared_edges_ == 0
                                         ? nothing_shared()
                                         : "no point lies inside a shared edge: with more segments "
                                           "some would");
    }

    // Values that say something: numbers, and of a normal not all 0.
    static bool is_defined(SeenPoint const& s, std::size_t first)
    {
        bool zero = true;
        for (std::size_t c = first; c < first + 3; ++c) {
            if (!std::isfinite(std::bit_cast<float>(s.bits[c]))) return false;
            zero = zero && std::bit_cast<float>(s.bits[c]) == 0;
        }
        return first != SeenPoint::kNormal || !zero;
    }

    CheckedVerdict equal_bits(char const* name, std::size_t first) const
    {
        CheckedVerdict v{name, Verdict::Pass, not_compared(), 0, 0, {}};
        std::size_t undefined = 0, parted = 0;
        std::map<std::string, std::array<std::uint64_t, 2>> by_edge; // checked, failures
        for (MeshPoint const* p : order_) {
            std::vector<SeenPoint> const& all = surface_.points().at(*p);
            // Of a normal each side of infinitely sharp edges by itself.
            std::map<std::uint16_t, std::vector<SeenPoint>> sides;
            for (SeenPoint const& s : all)
                sides[first == SeenPoint::kNormal ? s.side : 0].push_back(s);
            parted += sides.size() > 1;
            for (auto const& [side, seen] : sides) {
                int patches = 0;
                for (SeenPoint const& s : seen) patches += s.patches;
                if (patches < 2) continue;
                // That no patch has a normal is no agreement on one, and no crack.
                if (first == SeenPoint::kNormal && !is_defined(seen, first)) {
                    ++undefined;
                    continue;
                }
                auto& [checked, failures] = by_edge[surface_.edge_in_words(seen)];
                ++v.checked, ++checked;
                failures += !compare(v, *p, seen, first);
            }
        }
        if (undefined)
            v.reason =
                both(v.reason, counted(undefined, "point has a normal", "points have a normal") +
                                   " of length 0, or none, in all patches: left out");
        if (parted)
            v.reason = both(v.reason, counted(parted, "point", "points") +
                                          " on infinitely sharp edges left out across them: each "
                                          "side has its own normal");
        if (v.failures) v.reason = both(v.reason, in_words(by_edge));
        return settled(std::move(v), undefined ? "" : nothing_shared());
    }

    static bool is_defined(std::vector<SeenPoint> const& seen, std::size_t first)
    {
        return std::any_of(seen.begin(), seen.end(),
                           [&](SeenPoint const& s) { return is_defined(s, first); });
    }

    // Whether all that was seen of a point has the same bits, and numbers.
    bool compare(CheckedVerdict& v, MeshPoint const& at, std::vector<SeenPoint> const& seen,
                 std::size_t first) const
    {
        std::string const& edge = surface_.edge_in_words(seen);
        CrackSite site;
        if (!is_defined(seen, first)) {
            set_place(site, mesh_, at, seen.front().face, seen.back().face, edge);
            site.text += ": it is not finite";
            add(v, site);
            return false;
        }
        for (SeenPoint const& other : seen) {
            std::size_t c = first;
            while (c < first + 3 && other.bits[c] == seen[0].bits[c]) ++c;
            if (c == first + 3) continue;
            set_place(site, mesh_, at, seen[0].face, other.face, edge);
            site.component = int(c - first);
            site.bits[0] = seen[0].bits[c], site.bits[1] = other.bits[c];
            site.ulp = ulp_distance(site.bits[0], site.bits[1]);
            site.place = seen[0].displaced();
            site.text += std::string(": ") + "xyz"[site.component] + " is " +
                         hexadecimal(site.bits[0]) + " and " + hexadecimal(site.bits[1]) + ", " +
                         std::to_string(site.ulp) + " ulp apart";
            add(v, site);
            return false; // one failure a place
        }
        return true;
    }

    // How many points differ on which edges, where the scheme has words for some.
    static std::string in_words(std::map<std::string, std::array<std::uint64_t, 2>> const& by_edge)
    {
        std::string out;
        for (auto const& [edge, points] : by_edge)
            if (!edge.empty() && points[1])
                out = both(out, counted(points[1], "point", "points") + " of " +
                                    std::to_string(points[0]) + " differ on " + with_article(edge));
        auto const rest = by_edge.find("");
        if (!out.empty() && rest != by_edge.end() && rest->second[1])
            out = both(out, counted(rest->second[1], "point", "points") + " of " +
                                std::to_string(rest->second[0]) +
                                " differ at corners and on other edges");
        return out;
    }

    CheckedVerdict displaced() const
    {
        if (s_.frame.displacement) return equal_bits("displaced", SeenPoint::kDisplaced);
        return {"displaced", Verdict::Skipped, "the surface is not displaced", 0, 0, {}};
    }

    CheckedVerdict coverage() const
    {
        CheckedVerdict v{"coverage", Verdict::Pass, "", 0, 0, {}};
        if (open_edges_) {
            skip(v, is_open());
            return v;
        }
        // What is behind the eye is cut off, and what it balances is not. The near plane cuts
        // nothing here.
        if (surface_.extent().nearest < INFINITY && !lies_before_the_eye()) {
            skip(v,
                 "the eye is inside the surface, or some of it is behind the eye, where it is cut "
                 "off");
            return v;
        }
        count_hits(patches_, seen_surface(s_.frame), s_.frame.width, s_.frame.height, "", v);
        SurfaceSettings rounded = surface_settings(s_.frame);
        rounded.view_projection = view_projection(s_.frame.camera, 1);
        PointMoves half_pixels;
        half_pixels.lattice = kLattice;
        count_hits(MovedPoints(patches_, half_pixels), rounded, kLattice, kLattice,
                   ", vertices rounded to half pixels", v);
        return settled(std::move(v), "no sample was covered");
    }

    // Of w, which is rounded.
    bool lies_before_the_eye() const
    {
        SharedEdges::Extent const& e = surface_.extent();
        Camera const& camera = s_.frame.camera;
        glm::dvec3 const size = glm::max(glm::abs(glm::dvec3(e.low)), glm::abs(glm::dvec3(e.high)));
        return e.nearest > clip_rounding(camera.backward(), camera.eye, size);
    }

    void count_hits(PatchMesh const& patches, SurfaceSettings const& surface, int width, int height,
                    char const* what, CheckedVerdict& v) const
    {
        CoverageCounts counts(width, height);
        RasterTarget raster;
        raster.viewports = {{0, 0, float(width), float(height), 0, 1}};
        raster.rasterizer.cull = CullMode::None;
        raster.rasterizer.front_counter_clockwise = true;
        raster.rasterizer.depth_clip_enable = false; // near and far plane hide nothing
        raster.coverage = &counts;
        run_commands(frame_commands(patches, s_.frame, surface), threads_, {&raster});
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
            v.reason = is_open();
            return v;
        }
        SharedEdges::Extent const& extent = surface_.extent();
        if (!extent.finite || surface_.rays().triangles.empty() || extent.low == extent.high) {
            v.reason = !extent.finite ? "not all points are finite" : "the surface has no extent";
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
                site.face[0] = site.face[1] = mesh_.file_face(
                    aim == RayAim::Segments ? surface_.face_of_target()[m.triangle]
                                            : surface_.face_of_triangle()[m.triangle]);
                site.place = m.target;
                site.text = "a ray at the patch of face " + std::to_string(site.face[0] + 1) +
                            " slips through at " + std::to_string(m.target.x) + ", " +
                            std::to_string(m.target.y) + ", " + std::to_string(m.target.z) +
                            ": 113-bit arithmetic confirms it";
                add(v, site);
            }
        }
        std::uint64_t const confirmed = v.failures;
        if (past == v.checked) v.checked = 0; // all pass a surface that is a line: no word about it
        std::string pictures;
        // Through cracks that parity opened the picture shows what lies behind.
        CommandList list = frame_commands(patches_, s_.frame, seen_surface(s_.frame));
        if (list.primitives_are_patches() && s_.parity == 0) {
            VisibilityCheck const c = check_visibility(
                surface_.rays(), surface_.face_of_triangle(), visible_faces(std::move(list)),
                s_.frame.camera, s_.frame.width, s_.frame.height, threads_);
            v.checked += c.pixels;
            for (auto const& pixel : c.unexplained) {
                CrackSite site;
                site.pixel[0] = pixel[0], site.pixel[1] = pixel[1];
                site.text = "pixel " + std::to_string(pixel[0]) + ", " + std::to_string(pixel[1]) +
                            ": the picture and Embree's first hit show other patches";
                add(v, site);
            }
            pictures = !c.skipped.empty()
                           ? "; no picture is compared: " + c.skipped
                           : "; of " + std::to_string(c.pixels) + " pixels " +
                                 std::to_string(c.edges + c.silhouettes + c.depths +
                                                c.unexplained.size()) +
                                 " show another patch: " + std::to_string(c.edges) +
                                 " beside an edge, " + std::to_string(c.silhouettes) +
                                 " at a silhouette, " + std::to_string(c.depths) +
                                 " at equal depth, " + std::to_string(c.unexplained.size()) +
                                 " unexplained";
        }
        v.reason = "Embree missed " + std::to_string(refuted + folds + past + confirmed) +
                   " rays: " + std::to_string(refuted) + " hit in 113-bit arithmetic, " +
                   std::to_string(folds) + " meet a fold that is closed, " + std::to_string(past) +
                   " pass the outline by a rounding; " + std::to_string(control) +
                   " missed on a control with equal edges" + pictures;
        return settled(std::move(v), "no ray meets the surface");
    }

    /// The face that each pixel shows, -1 for none.
    std::vector<std::int64_t> visible_faces(CommandList list) const
    {
        int const width = s_.frame.width, height = s_.frame.height;
        ColorTarget color(width, height, Format::R32G32B32A32_FLOAT);
        DepthTarget depth(width, height, Format::D32_FLOAT);
        color.clear({-1, -1, -1, -1}, threads_);
        depth.clear(1, 0, threads_);
        RasterTarget raster{{&color}, &depth, {{0, 0, float(width), float(height), 0, 1}}};
        raster.rasterizer.cull = CullMode::None;
        std::vector<std::span<PatchPlace const>> draws;
        list.for_each_surface_draw([&](Draw& d) {
            d.pipeline.pixel_shader =
                bind_pixel_shader(IdPixelShader{float(draws.size())}, s_.frame.machine);
            draws.push_back(d.patches);
        });
        run_commands(list, threads_, {&raster});
        std::vector<std::int64_t> out;
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x) {
                auto const c = color.load(x, y);
                out.push_back(
                    c[0] < 0 ? -1 : std::int64_t(draws[std::size_t(c[1])][std::size_t(c[0])].face));
            }
        return out;
    }

    static constexpr int kLattice = 256;
    PatchMesh const& patches_;
    ControlMesh const& mesh_;
    WatertightSettings const& s_;
    ThreadPool const& threads_;
    SharedEdges surface_;
    std::size_t open_edges_, shared_edges_;
    Seams seams_;
    std::vector<MeshPoint const*> order_;
};

} // namespace

std::vector<CheckedVerdict> check_watertight(PatchMesh const& patches,
                                             WatertightSettings const& settings,
                                             ThreadPool const& threads)
{
    return Checker(MovedPoints(patches, {settings.parity}), settings, threads).run();
}

bool all_hold(std::vector<CheckedVerdict> const& verdicts)
{
    return std::none_of(verdicts.begin(), verdicts.end(),
                        [](CheckedVerdict const& v) { return v.verdict == Verdict::Fail; });
}

bool any_checked(std::vector<CheckedVerdict> const& verdicts)
{
    return std::any_of(verdicts.begin(), verdicts.end(),
                       [](CheckedVerdict const& v) { return v.verdict != Verdict::Skipped; });
}

ColorTarget draw_cracks(PatchMesh const& patches, WatertightSettings const& settings,
                        std::vector<CheckedVerdict> const& verdicts, ThreadPool const& threads)
{
    FrameSettings s = settings.frame;
    s.view = View::Lit;
    Frame frame = draw_frame(MovedPoints(patches, {settings.parity}), s, threads);
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
