// Random meshes by the number: every scheme, partitioning and some factors, with and without a
// planted mistake; every thirty-second mesh once more with faces joined, which is then subdivided.
// Prints progress and a summary; exit status 1 for a false alarm or a miss.
//
//     at_scale [MESHES] [FIRST_SEED]
//
// SPDX-License-Identifier: Apache-2.0
#include "analysis/mistakes.h"
#include "analysis/watertight.h"
#include "pipeline/schemes/scheme.h"
#include "tests/support/random_mesh.h"

#include <fmt/format.h>

#include <chrono>
#include <cstdlib>
#include <map>
#include <mutex>
#include <random>

#include <unistd.h>

using namespace tessemu;

namespace {

struct Summary {
    std::uint64_t meshes = 0, open = 0, checks = 0, points = 0, mistakes = 0;
    std::map<std::string, std::uint64_t> by_scheme, refused;
    std::map<std::string, std::uint64_t> without; ///< mistakes that a scheme cannot have
    std::vector<std::string> wrong;               ///< false alarms and misses

    Summary& operator+=(Summary const& o)
    {
        meshes += o.meshes, open += o.open, checks += o.checks, points += o.points;
        mistakes += o.mistakes;
        for (auto const& [k, n] : o.by_scheme) by_scheme[k] += n;
        for (auto const& [k, n] : o.refused) refused[k] += n;
        for (auto const& [k, n] : o.without) without[k] += n;
        wrong.insert(wrong.end(), o.wrong.begin(), o.wrong.end());
        return *this;
    }
};

constexpr Partitioning kPartitionings[] = {Partitioning::Integer, Partitioning::Pow2,
                                           Partitioning::FractionalOdd,
                                           Partitioning::FractionalEven};

bool shares_all_edges(Topology const& topology, std::uint32_t face)
{
    ControlMesh const& mesh = topology.mesh();
    for (HalfEdge h = mesh.face_start[face]; h < mesh.face_start[face + 1]; ++h)
        if (topology.twin(h) == Topology::kNone) return false;
    return true;
}

// A mesh's patches with a mistake, none where the scheme cannot have it.
std::unique_ptr<PatchMesh> mistaken(SchemeOnMesh const& m, PlantedMistake const& planted,
                                    FrameSettings const& frame)
{
    try {
        return with_mistake(*m.patches, planted, frame);
    } catch (Error const&) {
        return nullptr;
    }
}

void check_mesh(ControlMesh const& mesh, std::uint32_t seed, bool joined, Summary& out)
{
    std::mt19937 random(seed);
    ThreadPool const alone(1);
    ++out.meshes;
    bool open = false;
    for (auto const& of : schemes()) {
        std::string const scheme = of->info().name;
        SchemeOnMesh m;
        try {
            m = build_scheme(*of, mesh, {.set = of->info().watertight_with});
        } catch (Error const&) { // quads only, closed only, more than 32 inputs
            ++out.refused[scheme];
            continue;
        }
        ++out.by_scheme[scheme];
        for (Partitioning partitioning : kPartitionings) {
            WatertightSettings s;
            s.rays = 0;
            s.list = 1;
            s.frame.width = s.frame.height = 96;
            s.frame.partitioning = partitioning;
            s.frame.camera = frame_points(m.mesh->base().positions, {0.4f, 0.3f, 1}, 1);
            s.frame.tess_factor = 1 + float(random() % 1000) * 0.009f;
            s.frame.machine.contraction = Contraction(random() % 3);
            s.frame.machine.seed = random();
            auto const name = [&](char const* what) {
                return fmt::format("seed {}{}, {}, partitioning {}, factor {}, {}", seed,
                                   joined ? " joined" : "", scheme, int(partitioning),
                                   s.frame.tess_factor, what);
            };
            auto const verdicts = check_watertight(*m.patches, s, alone);
            ++out.checks;
            for (CheckedVerdict const& v : verdicts) {
                out.points += v.name == "position" ? v.checked : 0;
                if (v.name == "coverage") open = v.verdict == Verdict::Skipped;
                if (v.verdict == Verdict::Fail)
                    out.wrong.push_back(name("") + "false alarm: " + v.name + ": " +
                                        v.sites[0].text);
            }
            // Mistakes that must show on any mesh with a shared edge; one of them, in turn.
            Mistake const kind = std::array{Mistake::Order, Mistake::Factors, Mistake::Normals,
                                            Mistake::Fold}[random() % 4];
            if (kind == Mistake::Fold && open) continue; // nothing tells inside from outside
            PlantedMistake const planted = plant_mistake(*m.mesh, kind);
            if (kind == Mistake::Factors &&
                !shares_all_edges(m.mesh->base_topology(), planted.face))
                continue; // the edge with the other factor may have no other side
            // A factor two larger makes the same points where both are rounded to one power of two.
            s.frame.tess_factor = kind == Mistake::Factors ? 4.0f : 7.0f;
            auto const patches = mistaken(m, planted, s.frame);
            if (!patches) {
                ++out.without[scheme];
                continue;
            }
            auto const broken = check_watertight(*patches, s, alone);
            ++out.mistakes;
            std::string const must = kind == Mistake::Order     ? "position"
                                     : kind == Mistake::Factors ? "topology"
                                     : kind == Mistake::Normals ? "normal"
                                                                : "coverage";
            for (CheckedVerdict const& v : broken)
                if (v.name == must && v.verdict != Verdict::Fail)
                    out.wrong.push_back(name("") + "missed: " + std::string(name_of(kind)));
        }
    }
    out.open += open;
}

} // namespace

int main(int argc, char** argv)
{
    std::uint32_t const meshes =
        argc > 1 ? std::uint32_t(std::strtoul(argv[1], nullptr, 10)) : 1000;
    std::uint32_t const first = argc > 2 ? std::uint32_t(std::strtoul(argv[2], nullptr, 10)) : 1;
    auto const start = std::chrono::steady_clock::now();
    ThreadPool const threads;
    std::mutex mutex;
    Summary all;
    bool const bar = isatty(STDERR_FILENO);
    threads.parallel_for(meshes, [&](std::size_t i) {
        Summary one;
        std::uint32_t const seed = first + std::uint32_t(i);
        ControlMesh const mesh = test::random_mesh(seed);
        check_mesh(mesh, seed, false, one);
        if (seed % 32 == 0) check_mesh(test::join_faces(mesh, seed), seed, true, one);
        std::scoped_lock const lock(mutex);
        all += one;
        if (bar)
            fmt::print(stderr, "\r{} of {} meshes, {} wrong", all.meshes, meshes + meshes / 32,
                       all.wrong.size());
    });
    if (bar) fmt::print(stderr, "\r\033[K");
    double const seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    fmt::print("{} meshes ({} open), {} checks, {} shared points compared, {} planted mistakes, "
               "{:.0f} s\n",
               all.meshes, all.open, all.checks, all.points, all.mistakes, seconds);
    for (auto const& [scheme, n] : all.by_scheme)
        fmt::print("  {:<18} {} meshes, refused {}, without the mistake {}\n", scheme, n,
                   all.refused[scheme], all.without[scheme]);
    fmt::print("false alarms and misses: {}\n", all.wrong.size());
    for (std::string const& w : all.wrong) fmt::print("  {}\n", w);
    if (2 * all.mistakes < all.checks) fmt::print("too few mistakes were planted\n");
    return all.wrong.empty() && 2 * all.mistakes >= all.checks ? 0 : 1;
}
