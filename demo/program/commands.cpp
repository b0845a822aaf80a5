#include "demo/program/commands.h"

#include <fmt/format.h>

#include <string>

#include <mobil/assets/files/output_file.h>
#include "demo/program/console.h"
#include "demo/program/progress.h"

namespace mobil {

int complain(std::string_view command, std::string_view message, int status) {
  show("");
  print_error("mobil {}: {}", command, message);
  return status;
}

int exit_status_of(std::string_view command, const Result<void>& done) {
  return done ? 0 : complain(command, done.error().message);
}

Result<void> check_result_place(std::string_view option, const std::filesystem::path& file) {
  if (file.empty()) return fail(fmt::format("{} is empty; give it a file's name", option));
  const auto place = OutputFile::at(file);
  return place ? Result<void>{} : fail(fmt::format("{} {}", option, place.error().message));
}

void say_written(const std::filesystem::path& file) {
  say_where(fmt::format("written {}", one_line(file.string())));
}

void say_where(std::string_view line) {
  if (!quiet) print_note("{}\n", line);
}

Result<void> write_result(std::string_view option, const std::filesystem::path& file, std::string_view text) {
  if (auto done = write_file(file, text); !done) return fail(fmt::format("{} {}", option, done.error().message));
  say_written(file);
  return {};
}

}  // namespace mobil
