// SPDX-License-Identifier: Apache-2.0
#include "io/picture_library.h"

#include "emu/error.h"

#include <dlfcn.h>

namespace tessemu {

PictureLibrary const& picture_library()
{
    static PictureLibrary const* const library = [] {
        constexpr char kModule[] = "libtessemu_pictures.so", kSymbol[] = "tessemu_picture_library";
        auto const reason = [] {
            char const* const said = dlerror();
            return std::string(said ? said : "the linker does not say why");
        };
        // For as long as the program runs: libraries behind it do not like to be closed.
        void* const module = dlopen(kModule, RTLD_LAZY | RTLD_LOCAL);
        if (!module)
            throw Error(
                "pictures need the module " + std::string(kModule) +
                ", from the folder of the build or of the installed libraries: " + reason());
        void* const symbol = dlsym(module, kSymbol);
        if (!symbol) throw Error(std::string(kModule) + " is another version's: " + reason());
        return reinterpret_cast<decltype(&tessemu_picture_library)>(symbol)();
    }();
    return *library;
}

} // namespace tessemu
