// Results on their way to a file, a device, a pipe or standard output.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "emu/error.h"

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

namespace tessemu {

/// A result cannot be written; what() names where to and the reason.
struct WriteError : Error {
    using Error::Error;
};

/// Where a result goes.
///
/// A regular file, old or new, is whole or as it was: bytes go to a temporary in its folder, which
/// commit() renames. Symbolic links are followed. An old file's permissions stay, and its owner and
/// group as far as the process may give files away: root may, others may give a file to a group
/// that they are in. Else the file is the process's, and where the group is another it may do what
/// all others may.
///
/// A *stream* gets the bytes as they come: a device, a FIFO, an open descriptor (/dev/stdout,
/// /dev/fd/63), and standard output, "-". It is opened with its first bytes, since a FIFO waits
/// there for its reader.
class OutputFile {
public:
    /// Finds what can be found without writing: no such folder, one without room for a new name or
    /// without permission, a read-only file, a descriptor that is not open for writing. Throws
    /// WriteError.
    explicit OutputFile(std::filesystem::path path);
    /// Removes the temporary of what was not committed.
    ~OutputFile();
    OutputFile(OutputFile&&) noexcept;

    std::filesystem::path const& path() const; ///< as given
    /// Whether a path is a stream's, writable or not.
    static bool names_stream(std::filesystem::path const& path);
    bool is_stream() const;
    bool is_standard_output() const;
    /// Would what goes here and there mix, or one replace the other? Not on a character device.
    bool is_same(OutputFile const& other) const;
    /// Where large temporary data belongs: the file's folder; of a stream, the system's. Throws
    /// WriteError where the system names none.
    std::filesystem::path scratch_folder() const;

    /// Each throws WriteError where bytes are lost: a full disk, a limit, a reader that is gone.
    void write(std::string_view bytes);
    /// No more bytes may come.
    void close();
    /// Closes, and puts the file in its place; once.
    void commit();

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

/// Writes a whole text or byte string.
void write_file(std::filesystem::path const& path, std::string_view bytes);

/// Removes the temporaries of all OutputFiles; whoever opens or commits one afterwards waits for
/// good. For a process that a signal is about to end.
void remove_temporaries();

/// The extension without its dot, in lower case.
std::string extension_of(std::filesystem::path const& path);

} // namespace tessemu
