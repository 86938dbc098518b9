#include "apps/study_blind.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <filesystem>
#include <memory>

#include "blind/case_files.hpp"
#include "log/progress.hpp"
#include "log/whole_file.hpp"

namespace steerid {
namespace {

struct BlindOptions {
  std::filesystem::path out;
  std::size_t cases = 100;
  std::uint64_t seed = 1;
  bool two_effects = false;
};

void add_common(CLI::App& command, BlindOptions& options) {
  command.add_option("--out", options.out, "The folder of its files; made when missing")->required()->type_name("DIR");
  command.add_option("--cases", options.cases, "Records to draw")->check(CLI::Range(1, 100'000))->capture_default_str();
  command.add_option("--seed", options.seed, "Of everything that is drawn at random")->capture_default_str();
  command.add_flag("--two-effects", options.two_effects, "Two effects in every record");
}

std::string draw(const BlindOptions& options, const std::filesystem::path& cases) {
  const auto contents = options.two_effects ? blind::draw_pairs(options.cases, options.seed)
                                            : blind::draw_contents(options.cases, options.seed);
  Progress progress("drawing", options.cases);
  return blind::draw_and_write(contents, options.seed, cases, [&](std::size_t done) { progress.at(done); });
}

void draw_openly(const BlindOptions& options) {
  const std::string key = draw(options, options.out / "cases");
  write_whole_file(options.out / "key.json", key);
  fmt::print("{} records in {}, their answers in {}\n", options.cases, (options.out / "cases").string(),
             (options.out / "key.json").string());
}

}  // namespace

void add_study_blind(CLI::App& study) {
  CLI::App* blind = study.add_subcommand("blind", "How good the diagnosis is on withheld answers");
  blind->require_subcommand(1);
  auto options = std::make_shared<BlindOptions>();
  CLI::App* command = blind->add_subcommand("draw", "Only draw records, their answers beside them in key.json");
  add_common(*command, *options);
  command->callback([options] { draw_openly(*options); });
}

}  // namespace steerid
