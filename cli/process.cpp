// SPDX-License-Identifier: Apache-2.0
#include "cli/process.h"

#include "cli/run_output.h"

#include <cerrno>
#include <csignal>
#include <system_error>
#include <thread>

#include <fcntl.h>
#include <unistd.h>

namespace tessemu {

namespace {

bool is_ignored(int signal)
{
    struct sigaction now = {};
    return sigaction(signal, nullptr, &now) == 0 && now.sa_handler == SIG_IGN;
}

void end_by_signal(sigset_t ending)
{
    int signal = 0;
    if (sigwait(&ending, &signal) != 0) return;
    remove_temporaries();
    std::signal(signal, SIG_DFL);
    pthread_sigmask(SIG_UNBLOCK, &ending, nullptr);
    kill(getpid(), signal);
    for (;;) pause();
}

} // namespace

void set_up_process()
{
    for (int fd : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
        if (fcntl(fd, F_GETFD) < 0) // open takes the lowest number that is free
            static_cast<void>(open("/dev/null", fd == STDIN_FILENO ? O_WRONLY : O_RDONLY));

    std::signal(SIGPIPE, SIG_IGN);
    std::signal(SIGXFSZ, SIG_IGN);

    sigset_t ending;
    sigemptyset(&ending);
    for (int signal : {SIGINT, SIGTERM, SIGHUP})
        if (!is_ignored(signal)) sigaddset(&ending, signal); // nohup's, and a shell's with &
    pthread_sigmask(SIG_BLOCK, &ending, nullptr);
    try {
        std::thread(end_by_signal, ending).detach();
    } catch (std::system_error const&) { // no thread to be had: they end the process at once
        pthread_sigmask(SIG_UNBLOCK, &ending, nullptr);
    }
}

bool close_standard_output()
{
    if (close(STDOUT_FILENO) == 0 || errno == EBADF) return true;
    print_message("tessemu: standard output: " + std::generic_category().message(errno) + "\n");
    return false;
}

} // namespace tessemu
