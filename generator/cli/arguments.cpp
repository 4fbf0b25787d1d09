// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/arguments.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <utility>

#include "model/names.hpp"

namespace eomgen::cli {
namespace {

template <typename Accept>
ValueCheck number(const char* what, Accept accept) {
  return [what, accept](const std::string& text) {
    double value = 0;
    const bool fine = CLI::detail::lexical_cast(text, value) && std::isfinite(value) && accept(value);
    return fine ? std::string() : fmt::format("{} is not {}", model::quote(text), what);
  };
}

}  // namespace

ValueCheck finite_number() {
  return number("a number", [](double) { return true; });
}
ValueCheck positive_number() {
  return number("a number greater than 0", [](double value) { return value > 0; });
}
ValueCheck nonnegative_number() {
  return number("a number, 0 or greater", [](double value) { return value >= 0; });
}

ValueCheck whole_number(unsigned long long least, unsigned long long most) {
  return [least, most](const std::string& text) {
    const bool digits = !text.empty() && text.size() <= 19 && text.find_first_not_of("0123456789") == std::string::npos;
    const unsigned long long value = digits ? std::stoull(text) : 0;
    if (digits && value >= least && value <= most) return std::string();
    return fmt::format("{} is not a whole number from {} to {}", model::quote(text), least, most);
  };
}

Option Option::required() const {
  option_->required();
  return *this;
}

Option Option::check(ValueCheck complaint) const {
  option_->check(CLI::Validator([complaint = std::move(complaint)](std::string& text) { return complaint(text); }, ""));
  return *this;
}

Option Option::show_default() const {
  option_->capture_default_str();
  return *this;
}

Option Option::repeated() const {
  option_->allow_extra_args(false)->take_all();
  return *this;
}

Option Option::suggest_values(std::vector<std::string> words) const {
  words_[option_] = std::move(words);
  return *this;
}

template <typename T>
Option Arguments::add_option(const std::string& flags, T& target, const std::string& help) {
  return {app_.add_option(flags, target, help), words_};
}
template Option Arguments::add_option(const std::string&, std::string&, const std::string&);
template Option Arguments::add_option(const std::string&, double&, const std::string&);
template Option Arguments::add_option(const std::string&, int&, const std::string&);
template Option Arguments::add_option(const std::string&, std::uint64_t&, const std::string&);
template Option Arguments::add_option(const std::string&, std::optional<std::string>&, const std::string&);
template Option Arguments::add_option(const std::string&, std::optional<double>&, const std::string&);
template Option Arguments::add_option(const std::string&, std::vector<std::string>&, const std::string&);
Option Arguments::add_flag(const std::string& flags, bool& target, const std::string& help) {
  return {app_.add_flag(flags, target, help), words_};
}

Option Arguments::add_output_path(const std::string& flags, std::string& target, const std::string& help) {
  return add_option(flags, target, help).check([](const std::string& path) {
    return path.empty() ? std::string("'' names no file; - is standard output") : std::string();
  });
}

Option Arguments::add_list(const std::string& flag, std::vector<std::string>& target, const std::string& help,
                           char delimiter) {
  return {app_.add_option(flag, target, help)->delimiter(delimiter)->allow_extra_args(false), words_};
}

}  // namespace eomgen::cli
