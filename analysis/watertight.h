// Is a tessellated surface closed? Verdicts that are never merged into one word.
//
//   topology   shared edges have the same points from both sides
//   position   those points, and the corners, have equal bits in all patches that meet there
//   normal     so have their normals
//   displaced  so have the displaced points
//   coverage   on a closed, unclipped surface every sample has as many front as back hits, before
//              depth: in a picture, and in one whose vertices are rounded to half pixels, where
//              edges run through samples
//   raycast    rays from outside meet a front first; Embree traces, 113-bit arithmetic decides; and
//              the picture shows the patches that Embree sees, or a reason why not
//
// A verdict that does not apply, or that found nothing to check, is skipped, with the reason; none
// passes on nothing. docs/watertight.md explains.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "analysis/ray_check.h"
#include "pipeline/frame.h"

namespace tessemu {

enum class Verdict { Pass, Fail, Skipped };
/// "pass", "fail", "skipped"
std::string_view name_of(Verdict verdict);

/// What a verdict fails on.
struct CrackSite {
    std::uint32_t face[2] = {0, 0};   ///< of the file, from 0, whose patches they are; equal for a
                                      ///< pixel, a ray or two patches of one face
    std::uint32_t vertex[2] = {0, 0}; ///< the edge, from 0; equal for a corner and inside a face
    std::uint32_t t = 0;              ///< along it, in 1/65536 from vertex[0]
    int component = -1;               ///< x, y, z; -1 where no value differs
    std::uint32_t bits[2] = {0, 0};   ///< both values
    std::uint64_t ulp = 0;            ///< their distance
    int pixel[2] = {-1, -1};          ///< of a coverage failure
    int hits = 0;                     ///< front hits less back hits
    glm::vec3 place{0};               ///< object space, where it is known
    std::string edge;                 ///< in the scheme's words, see PatchKind; empty: none
    std::string text;                 ///< the same in words
};

struct CheckedVerdict {
    std::string name;
    Verdict verdict = Verdict::Skipped;
    std::string reason;        ///< why it is skipped, or a remark
    std::uint64_t checked = 0; ///< points, samples or rays
    std::uint64_t failures = 0;
    std::vector<CrackSite> sites; ///< the first of them
};

struct WatertightSettings {
    FrameSettings frame;         ///< its camera, size and factors; contraction, displacement, pose
    float parity = 0;            ///< moves every point, see PointMoves
    std::uint64_t rays = 200000; ///< of each kind; 0: no raycast
    std::size_t list = 100;      ///< sites a verdict lists at most
    std::uint32_t seed = 1;      ///< of the rays
    std::function<void(std::size_t, std::size_t)> progress; ///< steps done, of all; may be empty
};

/// The verdicts in the order above.
///
/// \cost  a tessellation for the edges, two draws, and the whole surface in memory for the rays
std::vector<CheckedVerdict> check_watertight(PatchMesh const& patches,
                                             WatertightSettings const& settings,
                                             ThreadPool const& threads);

/// False if any verdict fails.
bool all_hold(std::vector<CheckedVerdict> const& verdicts);
/// False if all verdicts are skipped.
bool any_checked(std::vector<CheckedVerdict> const& verdicts);

/// The lit picture with every listed site in red.
ColorTarget draw_cracks(PatchMesh const& patches, WatertightSettings const& settings,
                        std::vector<CheckedVerdict> const& verdicts, ThreadPool const& threads);

} // namespace tessemu
