// Windows of the rings of Gregory patches' corners, one thread a corner.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "shaders_cpp/gregory/gregory_ring.h"
#include "shaders_cpp/two_stage_form/ring_window.h"

namespace tessemu {

struct RingWindowShader : GregoryRing<CornerWindow::kMost, float> {
    using Ring = GregoryRing<CornerWindow::kMost, float>;
    static constexpr std::array<int, 3> kThreads{64, 1, 1};

    Buffer<std::uint32_t> corners; ///< [corner][CornerWindow]
    RWBuffer<float> windows;       ///< out: [corner] RingWindow

    std::vector<ResourceInfo> resources() const
    {
        std::vector<ResourceInfo> out = Ring::resources();
        out.push_back(corners.info());
        out.push_back(windows.info());
        return out;
    }

    template <class T> void operator()(ComputeGroup<T>& group) const
    {
        using Int = int_of<T>;
        using Window = RingWindow<T>;
        group.for_each_thread([&](ComputeInput<T> const& in) {
            Int const corner = linear_thread<RingWindowShader>(in),
                      words = corner * Int(CornerWindow::kWords);
            auto const word = [&](int which) -> Int {
                return Int(load<T>(corners, words + Int(which)));
            };
            // Not under when(): a sum here must be the place in the source that it is in the vertex
            // shader. Threads beyond the last corner read zeros and their stores are dropped.
            Int const vertex = word(CornerWindow::kVertex);
            Int const row = word(CornerWindow::kConstant);
            auto const at = Ring::template ring<T>(vertex);
            OfWindow<T> place;
            for (int k = 0; k < Window::kEdges; ++k)
                place.edges[k] = word(CornerWindow::kEdges + k);
            Window const made = Ring::template vertex<Window>(
                at, Ring::template position<T>(vertex), row, longest<T>(at.edges), place);
            for (int k = 0; k < Window::kVectors; ++k) {
                Int const out = (corner * Int(Window::kVectors) + Int(k)) * Int(3);
                float3<T> const& v = made.vectors[std::size_t(k)];
                store(windows, out, v.x);
                store(windows, out + Int(1), v.y);
                store(windows, out + Int(2), v.z);
            }
        });
    }

private:
    template <class T> struct OfWindow {
        int_of<T> edges[RingWindow<T>::kEdges];
        void edge(RingWindow<T>& out, int j, float3<T> const& e) const
        {
            put(out, RingWindow<T>::kE, j, e);
        }
        void second(RingWindow<T>& out, int j, float3<T> const& r) const
        {
            put(out, RingWindow<T>::kSecond, j, r);
        }

    private:
        void put(RingWindow<T>& out, int first, int j, float3<T> const& value) const
        {
            for (int k = 0; k < RingWindow<T>::kEdges; ++k) {
                float3<T>& v = out.vectors[std::size_t(first + k)];
                v = select(edges[k] == int_of<T>(j), value, v);
            }
        }
    };
};

} // namespace tessemu
