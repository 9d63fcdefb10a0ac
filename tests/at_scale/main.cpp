// Random meshes by the number: every scheme, partitioning and some factors, with and without a
// planted mistake. Prints progress and a summary; exit status 1 for a false alarm or a miss.
//
//     at_scale [MESHES] [FIRST_SEED]
//
// SPDX-License-Identifier: Apache-2.0
#include "analysis/watertight.h"
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
    std::vector<std::string> wrong; ///< false alarms and misses

    Summary& operator+=(Summary const& o)
    {
        meshes += o.meshes, open += o.open, checks += o.checks, points += o.points;
        mistakes += o.mistakes;
        for (auto const& [k, n] : o.by_scheme) by_scheme[k] += n;
        for (auto const& [k, n] : o.refused) refused[k] += n;
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

void check_mesh(std::uint32_t seed, Summary& out)
{
    ControlMesh const mesh = test::random_mesh(seed);
    std::mt19937 random(seed);
    ThreadPool const alone(1);
    ++out.meshes;
    bool open = false;
    for (auto const& technique : techniques()) {
        std::string const scheme = technique->info().name;
        PreparedMesh prepared;
        std::unique_ptr<PatchMesh> patches;
        try {
            prepared = prepare_mesh(mesh, *technique);
            patches = technique->build(*prepared.topology, {});
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
            s.frame.camera = frame_points(prepared.mesh->positions, {0.4f, 0.3f, 1}, 1);
            s.frame.tess_factor = 1 + float(random() % 1000) * 0.009f;
            s.frame.machine.contraction = Contraction(random() % 3);
            s.frame.machine.seed = random();
            auto const name = [&](char const* what) {
                return fmt::format("seed {}, {}, partitioning {}, factor {}, {}", seed, scheme,
                                   int(partitioning), s.frame.tess_factor, what);
            };
            auto const verdicts = check_watertight(*prepared.topology, *patches, s, alone);
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
            s.frame.mistake = plant_mistake(*prepared.topology, kind);
            if (kind == Mistake::Factors &&
                !shares_all_edges(*prepared.topology, s.frame.mistake.face))
                continue; // the edge with the other factor may have no other side
            // A factor two larger makes the same points where both are rounded to one power of two.
            s.frame.tess_factor = kind == Mistake::Factors ? 4.0f : 7.0f;
            auto const broken = check_watertight(*prepared.topology, *patches, s, alone);
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
        check_mesh(first + std::uint32_t(i), one);
        std::scoped_lock const lock(mutex);
        all += one;
        if (bar)
            fmt::print(stderr, "\r{} of {} meshes, {} wrong", all.meshes, meshes, all.wrong.size());
    });
    if (bar) fmt::print(stderr, "\r\033[K");
    double const seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    fmt::print("{} meshes ({} open), {} checks, {} shared points compared, {} planted mistakes, "
               "{:.0f} s\n",
               all.meshes, all.open, all.checks, all.points, all.mistakes, seconds);
    for (auto const& [scheme, n] : all.by_scheme)
        fmt::print("  {:<18} {} meshes, refused {}\n", scheme, n, all.refused[scheme]);
    fmt::print("false alarms and misses: {}\n", all.wrong.size());
    for (std::string const& w : all.wrong) fmt::print("  {}\n", w);
    return all.wrong.empty() ? 0 : 1;
}
