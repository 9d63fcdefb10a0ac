// SPDX-License-Identifier: Apache-2.0
#include "analysis/error_view.h"

#include "pipeline/colored_mesh.h"
#include "shaders_cpp/pixel/colored_view.h"

namespace tessemu {

namespace {

ColorTarget draw_heat(EqualParameterErrors const& e, std::vector<double> const& value, double max,
                      FrameSettings const& s, ThreadPool const& threads)
{
    ColoredMesh mesh;
    mesh.vertices.reserve(9 * value.size());
    for (std::size_t i = 0; i < value.size(); ++i) {
        float3<float> const c = heat_color(max > 0 ? float(value[i] / max) : 0.0f);
        mesh.add(glm::vec3(e.position[i]), glm::vec3(e.normal[i]), {c.x, c.y, c.z});
    }
    mesh.triangles = e.triangles;
    Frame frame(s);
    draw_colored_mesh(mesh, s, 0.7f, threads, frame);
    return std::move(frame.color);
}

} // namespace

ErrorView draw_error(EqualParameterErrors const& e, FrameSettings const& s, double position_max,
                     double normal_max, ThreadPool const& threads)
{
    return {draw_heat(e, e.distance, position_max, s, threads),
            draw_heat(e, e.angle, normal_max, s, threads)};
}

} // namespace tessemu
