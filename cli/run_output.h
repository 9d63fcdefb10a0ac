// What a run writes and prints.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "cli/session.h"
#include "io/output_file.h"

#include <deque>
#include <optional>
#include <vector>

namespace tessemu {

/// Prints to standard output. Throws WriteError where it cannot take all.
void print(std::string_view text);
/// Prints to standard error. Nobody can be told where that fails.
void print_message(std::string_view text);

/// The results of a run. Made before the work, so that what can fail fails before it; files get
/// their places at the end, one after the other, each whole or as it was.
class RunOutput {
public:
    /// \param json  a path, "-", or empty: no JSON
    explicit RunOutput(std::string const& json = "", Session const& session = {});

    /// Of -o. Throws WriteError where another result goes to the same place.
    OutputFile& add(std::string const& path);
    /// Throws WriteError where a result would replace this file, which the run reads. After all
    /// add().
    void keep(std::string const& input) const;
    /// Writes the JSON, prints the table where no result went to standard output, and puts the
    /// files in their places.
    /// \param json  makes it; hashes take their time
    template <class Json> void finish(Json&& json, std::string const& table)
    {
        if (result_) {
            *result_ = json();
            return;
        }
        close_files(); // a reader may take one pipe after another
        if (json_) json_->write(json());
        put_in_place(table);
    }

private:
    void refuse_same(OutputFile const& file, std::string const& option) const;
    void close_files();
    void put_in_place(std::string const& table);

    std::string* result_; // of the session
    OutputFile standard_output_;
    std::optional<OutputFile> json_;
    std::deque<OutputFile> files_; // references to them stay
};

} // namespace tessemu
