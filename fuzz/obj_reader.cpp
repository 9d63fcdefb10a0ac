// libFuzzer target: any bytes either read as a mesh or are refused with an Error; what is read goes
// on through topology, the Catmull-Clark step and the patch tables.
//
// SPDX-License-Identifier: Apache-2.0
#include "io/obj_reader.h"
#include "emu/error.h"
#include "pipeline/schemes/scheme.h"

#include <cstddef>
#include <cstdint>

extern "C" int LLVMFuzzerTestOneInput(std::uint8_t const* data, std::size_t size)
{
    using namespace tessemu;
    try {
        ObjFile file = read_obj({reinterpret_cast<char const*>(data), size}, "fuzz.obj");
        (void)build_scheme(find_scheme("gregory-stencil"), std::move(file.mesh));
    } catch (Error const&) {
    }
    return 0;
}
