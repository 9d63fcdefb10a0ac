// A sweep as its user writes it: a verb, a grid of options, single cases, exceptions.
//
//     {"verb": "draw", "models": ["jug", "cages/a.obj"], "schemes": ["acc", "pm"], "tess": [1, 2.5],
//      "cases": [{"model": "golem", "tess": 64}], "except": [{"scheme": "pm", "tess": 1}]}
//
// Keys are the verb's long options without dashes; "models" and "schemes" of the grid are "model" and
// "scheme" of a case. A value is one or a list of them; of an option that may be given several times
// ("set") an inner list is one value. All combinations are cases, in the order of the models, then
// of the schemes, then of the other keys as they stand, the last of which changes first.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "emu/error.h"

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace tessemu {

/// Options of a case by their names without dashes, as texts: one each; of a repeated option any
/// number, of a flag "true" or "false". The model is the option "model".
using CaseOptions = std::map<std::string, std::vector<std::string>>;

/// What a sweep knows of a verb.
struct SweepVerb {
    struct Option {
        std::string name; ///< without dashes
        bool repeated = false, flag = false, required = false;
        std::vector<std::string> fallback = {}; ///< empty: none
    };
    std::string name;
    std::vector<Option> options;
    /// Throws Error for a text that the option does not take; `label` names the option in it.
    std::function<void(Option const& option, std::string const& text, std::string const& label)>
        check;
};

struct Sweep {
    struct Axis {
        std::string option;
        std::vector<std::vector<std::string>> values;
    };
    std::string verb;
    std::vector<Axis> grid; ///< empty: cases alone; the first changes last
    std::vector<CaseOptions> cases;
    /// Left out is what has, for each option of an exception, one of its values.
    std::vector<std::vector<Axis>> except;
};

/// Refuses what is not of this form, keys that the verb does not have and values that it does not
/// take: FormatError with file, key, value and what is allowed.
///
/// \param text       of the file
/// \param find_verb  throws Error for a name that is none
Sweep read_sweep(std::string_view text, std::string const& file,
                 std::function<SweepVerb(std::string const& name)> const& find_verb);

/// What comes first: 0 the model, 1 the scheme, 2 all others.
int option_rank(std::string const& option);

/// At most so many combinations.
inline constexpr std::uint64_t kMostCases = 10'000'000;

/// All cases in order: the grid's, but for exceptions, then the single ones. Throws LimitError, and
/// Error for an exception that is none.
std::vector<CaseOptions> cases_of(Sweep const& sweep);

} // namespace tessemu
