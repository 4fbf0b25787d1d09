// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/program.hpp"

#include <cln/float.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <exception>
#include <new>
#include <string>
#include <string_view>
#include <utility>

#include "cli/declaration.hpp"
#include "cli/interrupt.hpp"
#include "cli/locate.hpp"
#include "cli/output.hpp"
#include "cli/stage_monitor.hpp"
#include "work.hpp"

namespace eomgen::cli {
namespace {

constexpr int exit_internal = 4;

int report(const Error& error) {
  print_message(error.what());
  // Messages name a page by its path in the source tree.
  if (std::string_view(error.what()).find("docs/model-format.md") != std::string_view::npos) {
    const std::string path = documentation_path("model-format.md");
    print_message(path == "docs/model-format.md" ? "  `eomgen docs model-format` shows docs/model-format.md\n"
                                                 : fmt::format("  docs/model-format.md is {}\n", path));
  }
  return error.exit_code();
}

/// Whether standard output is a pipe without a reader, as after `| head`.
bool has_lost_reader() {
  pollfd output{STDOUT_FILENO, POLLOUT, 0};
  return poll(&output, 1, 0) > 0 && (output.revents & POLLERR) != 0;
}

int output_lost() {
  print_message(has_lost_reader()
                    ? "error: the program that reads standard output ended before all of it was written\n  remedy: let "
                      "it read to the end, or write to a file\n"
                    : "error: standard output could not be written\n  remedy: see to space on that disk\n");
  return exit_internal;
}

/// Reopens closed standard streams. Otherwise the first opened file would get the descriptor, and messages would go
/// into results. Writing to a closed standard output then fails and is reported; messages to a closed standard error
/// are lost.
void open_closed_streams() {
  for (const auto& [stream, way] :
       {std::pair{STDIN_FILENO, O_WRONLY}, {STDOUT_FILENO, O_RDONLY}, {STDERR_FILENO, O_WRONLY}}) {
    if (fcntl(stream, F_GETFD) >= 0) continue;
    const int taken = open("/dev/null", way);
    if (taken >= 0 && taken != stream) {
      dup2(taken, stream);
      close(taken);
    }
  }
  std::signal(SIGPIPE, SIG_IGN);  // a closed pipe is reported as a write error, like a full disk
}

/// Prints warnings of the stages to standard error.
class MessagePrinter : public work::Listener {
 public:
  void on_warning(const std::string& text) override { print_message(text); }
};

}  // namespace

int run_program(std::span<char* const> typed, const char* name, std::span<const Command> commands,
                ProcessGroup* group) try {
  open_closed_streams();
  Declaration declared(name, commands);
  declared.common.group = group;
  if (const std::optional<int> code = declared.read(typed)) return *code;
  install_signal_handlers();
  const StageMonitor watch;
  const MessagePrinter teller;
  const work::Stage stage("reading the model");
  const int code = declared.execute();
  // A full disk or a closed pipe loses results, which is an error.
  if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0) return output_lost();
  return code;
} catch (const Error& error) {
  return report(error);
} catch (const work::Interrupted&) {
  print_interrupted(nullptr);
  return exit_interrupted;
} catch (const cln::floating_point_exception&) {
  return report(Error("numbers", SourceLocation{},
                      "a value of this model is beyond what binary64 holds (1e308 in size)",
                      "use units in which its masses, lengths and times are nearer to 1"));
} catch (const std::bad_alloc&) {
  print_message("error: out of memory\n  remedy: make the model smaller\n");
  return exit_internal;
} catch (const std::exception& error) {
  if (std::ferror(stdout) != 0) return output_lost();  // printing throws
  print_message(fmt::format("error: internal: {}\n  remedy: please report this, with the model\n", error.what()));
  return exit_internal;
}

}  // namespace eomgen::cli
