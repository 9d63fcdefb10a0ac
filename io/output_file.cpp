// SPDX-License-Identifier: Apache-2.0
#include "io/output_file.h"

#include <cassert>
#include <cerrno>
#include <charconv>
#include <cstdlib>
#include <mutex>
#include <optional>
#include <set>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

namespace tessemu {

namespace fs = std::filesystem;

namespace {

std::string reason(int error)
{
    std::string const text = std::generic_category().message(error);
    return error == EPIPE ? text + ": its reader is gone" : text;
}

// A signal ends a whole process, hence one list of what it leaves behind.
struct Temporaries {
    std::mutex mutex;
    std::set<fs::path> paths;
    std::uint64_t made = 0;
};

Temporaries& temporaries()
{
    static Temporaries& all = *new Temporaries; // outlives whoever waits for a signal
    return all;
}

// A new file in a folder, by a short name: the target's own may have no room for more.
std::pair<fs::path, int> make_temporary(fs::path const& folder)
{
    Temporaries& t = temporaries();
    std::lock_guard const lock(t.mutex);
    for (;;) {
        fs::path path = folder / (".tessemu-" + std::to_string(getpid()) + "-" +
                                  std::to_string(t.made++) + ".tmp");
        int const fd = open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (fd < 0 && errno == EEXIST) continue;
        if (fd < 0) return {path, -errno};
        t.paths.insert(path);
        return {std::move(path), fd};
    }
}

void remove_temporary(fs::path const& path)
{
    Temporaries& t = temporaries();
    std::lock_guard const lock(t.mutex);
    unlink(path.c_str());
    t.paths.erase(path);
}

// The number of a descriptor that /proc shows as `name` in `folder`, if it is this process's.
std::optional<int> own_descriptor(fs::path const& folder, std::string const& name)
{
    std::error_code ec;
    if (folder != fs::canonical("/proc/self/fd", ec) &&
        folder != fs::canonical("/proc/thread-self/fd", ec))
        return {};
    int number = -1;
    auto const [end, error] = std::from_chars(name.data(), name.data() + name.size(), number);
    if (error != std::errc() || end != name.data() + name.size()) return {};
    return number;
}

} // namespace

struct OutputFile::Impl {
    enum class Kind { File, Stream, Descriptor };

    fs::path given, target, temporary;
    Kind kind = Kind::File;
    int descriptor = -1; // of Kind::Descriptor
    struct stat status = {};
    bool exists = false;
    int fd = -1;
    bool closed = false, committed = false;
    std::string buffer;

    [[noreturn]] void fail(std::string const& why) const
    {
        throw WriteError((given == "-" ? "standard output" : given.string()) + ": " + why);
    }
    [[noreturn]] void fail_to_write(int error) const
    {
        fail("cannot be written: " + reason(error));
    }

    // Follows links, to one of the process's descriptors or to where a file is or will be.
    void resolve()
    {
        if (given == "-") {
            kind = Kind::Descriptor;
            descriptor = STDOUT_FILENO;
            return;
        }
        target = given;
        constexpr int kMostLinks = 40; // as Linux
        for (int i = 0; i < kMostLinks; ++i) {
            if (!target.has_filename()) fail("is a folder's name");
            std::error_code ec;
            fs::path folder = target.has_parent_path() ? target.parent_path() : fs::path(".");
            if (!fs::is_directory(folder, ec)) {
                bool const hidden = ec == std::errc::permission_denied;
                fail("the folder " + folder.string() +
                     (hidden ? ": " + ec.message() : " does not exist"));
            }
            folder = fs::canonical(folder, ec);
            if (ec) fail_to_write(ec.value());
            target = folder / target.filename();
            if (auto const own = own_descriptor(folder, target.filename().string())) {
                kind = Kind::Descriptor;
                descriptor = *own;
                return;
            }
            fs::path const next = fs::read_symlink(target, ec);
            if (ec) return; // no link
            target = next.is_absolute() ? next : folder / next;
        }
        fail_to_write(ELOOP);
    }

    void check()
    {
        if (kind == Kind::Descriptor) {
            int const flags = fcntl(descriptor, F_GETFL);
            if (flags < 0 || (flags & O_ACCMODE) == O_RDONLY) fail("is not open for writing");
            if (fstat(descriptor, &status) != 0) fail_to_write(errno);
            exists = true;
            return;
        }
        exists = stat(target.c_str(), &status) == 0;
        if (!exists && errno != ENOENT) fail_to_write(errno);
        if (exists && S_ISDIR(status.st_mode)) fail("is a folder");
        if (exists && S_ISSOCK(status.st_mode)) fail("is a socket");
        // Root may write to what nobody may, and does not mean to.
        if (exists && (access(target.c_str(), W_OK) != 0 || (status.st_mode & 0222) == 0))
            fail("is read-only");
        if (exists && !S_ISREG(status.st_mode)) {
            kind = Kind::Stream;
            return;
        }
        make_in_folder(); // more than permissions decide: a read-only disk, quotas, /proc
        drop();
    }

    void make_in_folder()
    {
        auto const [path, opened] = make_temporary(target.parent_path());
        if (opened < 0)
            fail("its folder " + target.parent_path().string() +
                 " takes no new file: " + reason(-opened));
        temporary = path;
        fd = opened;
    }

    void open_target()
    {
        if (kind == Kind::Descriptor)
            fd = fcntl(descriptor, F_DUPFD_CLOEXEC, 0);
        else if (kind == Kind::Stream)
            fd = open(target.c_str(), O_WRONLY | O_CLOEXEC | O_NOCTTY);
        else
            make_in_folder();
        if (fd < 0) fail_to_write(errno);
        if (kind == Kind::File && exists) {
            // Only root may give files away, others to a group that they are in. Another group
            // gets no more than it had as one of all others.
            struct stat now = {};
            bool const kept = fchown(fd, status.st_uid, status.st_gid) == 0 ||
                              fchown(fd, uid_t(-1), status.st_gid) == 0 ||
                              (fstat(fd, &now) == 0 && now.st_gid == status.st_gid);
            mode_t const mode = status.st_mode & 0777;
            if (fchmod(fd, kept ? mode : (mode & 0707) | (mode & 0007) << 3) != 0)
                fail_to_write(errno);
        }
    }

    void send(std::string_view bytes)
    {
        while (!bytes.empty()) {
            ssize_t const n = ::write(fd, bytes.data(), bytes.size());
            if (n >= 0) {
                bytes.remove_prefix(std::size_t(n));
            } else if (errno == EAGAIN) { // a pipe that another process made non-blocking
                pollfd ready{fd, POLLOUT, 0};
                poll(&ready, 1, -1);
            } else if (errno != EINTR) {
                fail_to_write(errno);
            }
        }
    }

    void drop()
    {
        if (fd >= 0) ::close(fd);
        fd = -1;
        if (!temporary.empty()) remove_temporary(temporary);
        temporary.clear();
    }
};

OutputFile::OutputFile(fs::path path) : impl_(std::make_unique<Impl>())
{
    impl_->given = std::move(path);
    impl_->resolve();
    impl_->check();
}

OutputFile::~OutputFile()
{
    if (impl_) impl_->drop();
}

OutputFile::OutputFile(OutputFile&&) noexcept = default;

fs::path const& OutputFile::path() const
{
    return impl_->given;
}

bool OutputFile::names_stream(fs::path const& path)
{
    Impl m;
    m.given = path;
    try {
        m.resolve();
    } catch (WriteError const&) {
        return false;
    }
    if (m.kind == Impl::Kind::Descriptor) return true;
    return stat(m.target.c_str(), &m.status) == 0 && !S_ISREG(m.status.st_mode) &&
           !S_ISDIR(m.status.st_mode);
}

bool OutputFile::is_stream() const
{
    return impl_->kind != Impl::Kind::File;
}

bool OutputFile::is_standard_output() const
{
    return impl_->descriptor == STDOUT_FILENO;
}

bool OutputFile::is_same(OutputFile const& other) const
{
    Impl const &a = *impl_, &b = *other.impl_;
    if (a.kind == b.kind && a.kind == Impl::Kind::File) return a.target == b.target;
    if (a.kind == b.kind && a.kind == Impl::Kind::Descriptor && a.descriptor == b.descriptor)
        return true;
    return a.exists && b.exists && !S_ISCHR(a.status.st_mode) &&
           a.status.st_dev == b.status.st_dev && a.status.st_ino == b.status.st_ino;
}

fs::path OutputFile::scratch_folder() const
{
    if (!is_stream()) return impl_->target.parent_path();
    std::error_code ec;
    fs::path folder = fs::temp_directory_path(ec);
    if (ec) {
        char const* const named = std::getenv("TMPDIR");
        impl_->fail("needs a folder for temporary files, TMPDIR is " +
                    (named ? "'" + std::string(named) + "'" : "not set") + ": " + ec.message());
    }
    return folder;
}

void OutputFile::write(std::string_view bytes)
{
    Impl& m = *impl_;
    assert(!m.closed);
    constexpr std::size_t kBlock = 1 << 16;
    if (m.fd < 0) m.open_target();
    if (m.buffer.size() + bytes.size() < kBlock) {
        m.buffer += bytes;
        return;
    }
    m.send(m.buffer);
    m.buffer.clear();
    m.send(bytes);
}

void OutputFile::close()
{
    Impl& m = *impl_;
    m.closed = true;
    if (m.fd < 0) return;
    m.send(m.buffer);
    m.buffer.clear();
    int const fd = std::exchange(m.fd, -1);
    if (::close(fd) != 0 && errno != EINTR) m.fail_to_write(errno);
}

void OutputFile::commit()
{
    Impl& m = *impl_;
    assert(!m.committed);
    m.committed = true;
    if (m.fd < 0 && m.temporary.empty() && !is_stream()) m.open_target();
    close();
    if (m.temporary.empty()) return;
    Temporaries& t = temporaries();
    std::lock_guard const lock(t.mutex);
    if (rename(m.temporary.c_str(), m.target.c_str()) != 0) m.fail_to_write(errno);
    t.paths.erase(m.temporary);
    m.temporary.clear();
}

void write_file(fs::path const& path, std::string_view bytes)
{
    OutputFile out(path);
    out.write(bytes);
    out.commit();
}

void remove_temporaries()
{
    Temporaries& t = temporaries();
    t.mutex.lock(); // and stays locked
    for (fs::path const& path : t.paths) unlink(path.c_str());
}

std::string extension_of(fs::path const& path)
{
    std::string out = path.extension().string();
    if (!out.empty()) out.erase(0, 1);
    for (char& c : out)
        if (c >= 'A' && c <= 'Z') c = char(c - 'A' + 'a');
    return out;
}

} // namespace tessemu
