// SPDX-License-Identifier: Apache-2.0
#include "pipeline/mesh/animation.h"

#include "emu/error.h"

#include <glm/common.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace tessemu {

namespace {

// A smooth wave of period 1 between -1 and 1: two parabolas, as sine has them nearly.
double wave(double x)
{
    double const f = x - std::floor(x);
    return f < 0.5 ? 16 * f * (0.5 - f) : -16 * (f - 0.5) * (1 - f);
}

} // namespace

glm::vec3 Pose::posed(std::size_t vertex, glm::vec3 p) const
{
    std::uint32_t const numbers = skin->vertices[2 * vertex],
                        weights = skin->vertices[2 * vertex + 1];
    glm::vec3 sum(0);
    for (unsigned i = 0; i < 4; ++i) {
        float const w = float(weights >> (8 * i) & 255) / 255;
        float const* const m = bones.data() + 12 * std::size_t(numbers >> (8 * i) & 255);
        for (int r = 0; r < 3; ++r)
            sum[r] += w * (m[4 * r] * p.x + m[4 * r + 1] * p.y + m[4 * r + 2] * p.z + m[4 * r + 3]);
    }
    return sum;
}

SpineRig::SpineRig(ControlMesh const& mesh, int bones)
{
    if (bones < 2 || bones > 255)
        throw Error("a spine has " + std::to_string(bones) + " bones, it must be 2 to 255");
    if (mesh.positions.empty()) throw Error("a mesh without vertices has no spine");
    glm::vec3 low = mesh.positions[0], high = low;
    for (glm::vec3 const& p : mesh.positions) low = min(low, p), high = max(high, p);
    glm::vec3 const size = high - low;
    std::array<int, 3> axes{0, 1, 2};
    std::stable_sort(axes.begin(), axes.end(), [&](int a, int b) { return size[a] > size[b]; });
    along_ = axes[0];
    across_ = axes[1];
    foot_ = 0.5f * (low + high);
    foot_[along_] = low[along_];
    length_ = size[along_];

    auto skin = std::make_shared<Skin>();
    skin->bones = bones;
    for (glm::vec3 const& p : mesh.positions) {
        // Bone b is at home in the middle of its piece of the axis.
        float const at =
            length_ > 0 ? (p[along_] - low[along_]) / length_ * float(bones) - 0.5f : 0.0f;
        float const clamped = std::clamp(at, 0.0f, float(bones - 1));
        auto const first = std::min(std::uint32_t(clamped), std::uint32_t(bones - 2));
        float const f = clamped - float(first);
        auto const weight = std::uint32_t(255 * (f * f * (3 - 2 * f)) + 0.5f);
        skin->vertices.push_back(first | (first + 1) << 8);
        skin->vertices.push_back((255 - weight) | weight << 8);
    }
    skin_ = std::move(skin);
}

Pose SpineRig::sway(double phase) const
{
    constexpr double kBend = 0.11; // tan(angle / 2) at a joint, at most: 13 degrees
    Pose pose{skin_, {}};
    int const bones = skin_->bones;
    // Of the bones so far: p' = R (p - joint) + moved, in the plane of along and across.
    double c = 1, s = 0, along = foot_[along_], across = foot_[across_];
    double joint = along;
    for (int b = 0; b < bones; ++b) {
        if (b > 0) {
            double const step = double(length_) / bones;
            along += c * step;
            across += s * step;
            joint += step;
            double const t = kBend * wave(phase - double(b) / bones);
            double const cos = (1 - t * t) / (1 + t * t), sin = 2 * t / (1 + t * t);
            std::tie(c, s) = std::pair(c * cos - s * sin, s * cos + c * sin);
        }
        std::array<float, 12> m{};
        for (int r = 0; r < 3; ++r) m[std::size_t(5 * r)] = 1;
        auto const at = [&](int row, int column) -> float& {
            return m[std::size_t(4 * row + column)];
        };
        double const home = foot_[across_];
        at(along_, along_) = float(c);
        at(along_, across_) = float(-s);
        at(along_, 3) = float(along - c * joint + s * home);
        at(across_, along_) = float(s);
        at(across_, across_) = float(c);
        at(across_, 3) = float(across - s * joint - c * home);
        pose.bones.insert(pose.bones.end(), m.begin(), m.end());
    }
    return pose;
}

} // namespace tessemu
