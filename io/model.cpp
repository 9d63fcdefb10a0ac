// SPDX-License-Identifier: Apache-2.0
#include "io/model.h"

#include "emu/error.h"
#include "io/input_file.h"
#include "io/sha256.h"
#include "pipeline/mesh/builtin_models.h"

namespace tessemu {

Model load_model(std::string const& path_or_name, WarningSink const& sink)
{
    std::string text;
    bool found = path_or_name == "-" || std::filesystem::exists(path_or_name);
    if (found) {
        text = read_file(path_or_name);
    } else {
        std::string known;
        for (BuiltinModel const& m : builtin_models()) {
            if (m.name == path_or_name) text = m.obj, found = true;
            known += (known.empty() ? "" : ", ") + std::string(m.name);
        }
        if (!found)
            throw FormatError(path_or_name, 0,
                              "no such file, and no built-in cage (" + known + ")");
    }
    Model out;
    ObjFile obj = read_obj(text, input_name(path_or_name), sink);
    out.name = std::filesystem::path(path_or_name).filename().string();
    out.mesh = std::move(obj.mesh);
    out.placement = obj.placement;
    out.mesh.name = out.name;
    out.lines = std::move(obj.lines);
    out.warnings = std::move(obj.warnings);
    out.sha256 = sha256_of(text);
    return out;
}

} // namespace tessemu
