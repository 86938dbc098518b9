// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

// A blind study is three processes of this program:
//   1  seal       draws records and seals their answers
//   2  diagnose   --batch over the records; it is told nothing else
//   3  score      opens the seal
#include "apps/study_blind.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>

#include "apps/made_from.hpp"
#include "apps/option_kinds.hpp"
#include "apps/own_process.hpp"
#include "apps/sealed_key.hpp"
#include "apps/seed_option.hpp"
#include "blind/case_files.hpp"
#include "blind/catalogue.hpp"
#include "fleet/file_hash.hpp"
#include "log/bad_input.hpp"
#include "log/output_folder.hpp"
#include "log/progress.hpp"
#include "log/whole_file.hpp"
#include "plant/json_text.hpp"
#include "study/blind_files.hpp"

namespace steerid {
namespace {

using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

struct BlindOptions {
  fs::path out;
  std::size_t cases = 100;
  std::uint64_t seed = 1;
  bool two_effects = false;
  bool several = false;
  bool remainder = false;
  bool leave_one_out = false;
  bool position_loop = false;
};

/// Records of one kind in a folder of their own; `without` is the effect that the diagnosis does without.
struct RecordSet {
  std::string name;
  std::vector<blind::Contents> contents;
  std::string without;
};

constexpr const char* kSingle = "single";
constexpr const char* kPairs = "pairs";
constexpr const char* kSeveral = "several";
constexpr const char* kLeftOut = "left_out";

std::vector<blind::Contents> known_contents(const BlindOptions& options) {
  if (options.two_effects) return blind::draw_pairs(options.cases, options.seed);
  if (options.several) return blind::draw_several(options.cases, options.seed);
  return blind::draw_contents(options.cases, options.seed);
}

std::vector<blind::Contents> contents(const BlindOptions& options) {
  std::vector<blind::Contents> all = known_contents(options);
  return options.remainder ? blind::with_remainders(std::move(all), options.seed) : all;
}

std::vector<RecordSet> record_sets(const BlindOptions& options) {
  if (!options.leave_one_out) {
    return {{options.two_effects ? kPairs : options.several ? kSeveral : kSingle, contents(options), ""}};
  }
  std::vector<RecordSet> sets;
  const auto effects = blind::vocabulary();
  for (std::size_t i = 0; i < effects.size(); ++i) {
    const std::string id(effects[i]->id);
    const std::size_t count = options.cases / effects.size() + (i < options.cases % effects.size() ? 1 : 0);
    if (count > 0) sets.push_back({fmt::format("{}/{}", kLeftOut, id), std::vector(count, blind::Contents{id}), id});
  }
  return sets;
}

/// The seed of a set: sets of one study share no record.
std::uint64_t set_seed(const BlindOptions& options, std::size_t set) { return options.seed + 1'000'003 * set; }

/// Draws every set below FOLDER/records; the key holds one object a set.
Json draw(const BlindOptions& options, const fs::path& records) {
  Json key = Json::object();
  const std::vector<RecordSet> sets = record_sets(options);
  Progress progress("drawing", options.cases);
  std::size_t before = 0;
  for (std::size_t i = 0; i < sets.size(); ++i) {
    const RecordSet& set = sets[i];
    key[set.name] =
        Json::parse(blind::draw_and_write(set.contents, set_seed(options, i), options.position_loop, records / set.name,
                                          [&](std::size_t done) { progress.at(before + done); }));
    before += set.contents.size();
  }
  return key;
}

void draw_openly(const BlindOptions& options) {
  const fs::path key_file = options.out / "key.json";
  make_output_folder(options.out);
  check_output_file(key_file);
  Progress progress("drawing", options.cases);
  const std::string key = blind::draw_and_write(contents(options), options.seed, options.position_loop,
                                                options.out / "cases", [&](std::size_t done) { progress.at(done); });
  write_whole_file(key_file, key);
  fmt::print("{} records in {}, their answers in {}\n", options.cases, printable((options.out / "cases").string()),
             printable(key_file.string()));
}

void draw_and_seal(const BlindOptions& options) {
  make_output_folder(options.out);
  const Json key = {{"seed", options.seed}, {"sets", draw(options, options.out / "records")}};
  const std::string hash = seal(options.out, key.dump(1) + "\n");
  fmt::print("{} records drawn, answers sealed: {}\n", options.cases, hash);
}

std::vector<blind_study::Case> cases_of(const Json& set, const fs::path& answers, const std::string& prefix) {
  // A batch that came to its end has a table; until then a record without an answer is one that was not reached yet.
  const bool complete = fs::exists(answers / "table.csv");
  std::vector<blind_study::Case> cases;
  for (auto& [name, truth] : blind_study::read_key(set.dump(), "the key")) {
    auto answer = blind_study::read_answer(answers / name / "diagnosis.json");
    if (answer || complete) cases.push_back({prefix + name, truth, std::move(answer)});
  }
  return cases;
}

void append(std::vector<blind_study::Case>& all, std::vector<blind_study::Case> more) {
  all.insert(all.end(), more.begin(), more.end());
}

/// A seed and at least one set.
Json sealed_sets(const std::string& text, const fs::path& folder) {
  const std::string file = (folder / "sealed" / "key.json").string();
  Json key = parse_json<Json>(text, file);
  const bool whole = key.is_object() && key.contains("seed") && key["seed"].is_number_unsigned() &&
                     key.contains("sets") && key["sets"].is_object() && !key["sets"].empty();
  if (!whole) {
    throw bad_input({.file = file,
                     .expected = "the sealed key of a blind study, with a seed and its sets",
                     .found = in_quotes(key.dump()),
                     .advice = "draw anew"});
  }
  return key;
}

void score(const fs::path& folder) {
  const std::string text = open_seal(folder);
  const Json key = sealed_sets(text, folder);
  blind_study::Study study{.seed = key["seed"], .key_sha256 = sha256(text)};
  for (const auto& [name, set] : key["sets"].items()) {
    const fs::path answers = folder / "answers" / name;
    if (name == kSingle) append(study.cases, cases_of(set, answers, ""));
    if (name == kSeveral) append(study.several, cases_of(set, answers, ""));
    if (name == kPairs) append(study.pairs, cases_of(set, answers, ""));
    if (!name.starts_with(kLeftOut)) continue;
    const std::string prefix = name.substr(name.find('/') + 1) + "/";
    append(study.left_out, cases_of(set, answers, prefix));
    append(study.left_out_whole, cases_of(set, folder / "answers_whole" / name, prefix));
  }
  fmt::print("{}", blind_study::blind_text(study));
  blind_study::write_blind_study(folder, study, {{"options", {{"out", folder.string()}}}, {"program", program_json()}});
  fmt::print("written to {}: blind.json, blind.csv, blind.html\n", printable(folder.string()));
}

constexpr int kBadData = 1;

/// What the part complained of stands on standard error already.
[[noreturn]] void end_as_part(const std::vector<std::string>& arguments, int code) {
  const std::string says = fmt::format("`steerid {}` ended with {}", fmt::join(arguments, " "), code);
  if (code == kBadData) throw BadInput(says);
  throw std::runtime_error(says);
}

void run_part(const std::vector<std::string>& arguments) {
  if (const int code = run_own_process(arguments); code != 0) end_as_part(arguments, code);
}

/// A refused record is a result: it ends a batch with the exit code of bad data after all others are done, when there
/// is a table.
void diagnose_set(const fs::path& records, const fs::path& answers, const std::string& without) {
  std::vector<std::string> arguments = {"diagnose", "--batch",        records.string(),
                                        "--out",    answers.string(), "--no-report"};
  if (!without.empty()) arguments.insert(arguments.end(), {"--without", without});
  const fs::path table = answers / "table.csv";
  std::error_code not_there;
  fs::remove(table, not_there);  // an earlier run's
  const int code = run_own_process(arguments);
  if (code != 0 && !(code == kBadData && fs::exists(table))) end_as_part(arguments, code);
}

/// Whether something was named without the effect that is there, and a folder of such records alone: only of these does
/// it matter what the whole library calls equivalent.
bool gather_named(const fs::path& records, const fs::path& answers, const fs::path& into) {
  bool any = false;
  for (const fs::directory_entry& record : fs::directory_iterator(records)) {
    const fs::path name = record.path().filename();
    const auto answer = blind_study::read_answer(answers / name / "diagnosis.json");
    if (!answer || answer->verdict == "unknown") continue;
    any = true;
    make_folders(into);
    if (!fs::exists(into / name)) fs::create_directory_symlink(fs::absolute(record.path()), into / name);
  }
  return any;
}

void whole_study(const BlindOptions& options) {
  make_output_folder(options.out);
  std::vector<std::string> drawing = {"study",
                                      "blind",
                                      "seal",
                                      "--cases",
                                      std::to_string(options.cases),
                                      "--seed",
                                      std::to_string(options.seed),
                                      "--out",
                                      options.out.string()};
  if (options.two_effects) drawing.emplace_back("--two-effects");
  if (options.several) drawing.emplace_back("--several");
  if (options.remainder) drawing.emplace_back("--remainder");
  if (options.leave_one_out) drawing.emplace_back("--leave-one-out");
  if (options.position_loop) drawing.emplace_back("--position-loop");
  run_part(drawing);
  for (const RecordSet& set : record_sets(options)) {
    const fs::path records = options.out / "records" / set.name;
    const fs::path answers = options.out / "answers" / set.name;
    diagnose_set(records, answers, set.without);
    if (set.without.empty()) continue;
    const fs::path named = options.out / "records_named" / set.name;
    if (gather_named(records, answers, named)) diagnose_set(named, options.out / "answers_whole" / set.name, "");
  }
  run_part({"study", "blind", "score", "--out", options.out.string()});
}

void add_out(CLI::App& command, BlindOptions& options) {
  writes_folder(command.add_option("--out", options.out, "The folder of its files; made when missing"))
      ->type_name("DIR");
}

void add_options(CLI::App& command, BlindOptions& options) {
  add_out(command, options);
  whole_from(command.add_option("--cases", options.cases, "Records to draw"), 1, 100'000)
      ->type_name("COUNT")
      ->capture_default_str();
  add_seed(command, options.seed);
  CLI::Option* two = command.add_flag("--two-effects", options.two_effects, "Two effects in every record");
  CLI::Option* several = command
                             .add_flag("--several", options.several,
                                       "Up to four effects in every record; simulations that have some of them, "
                                       "of another size, or some that the wheel has not")
                             ->excludes(two);
  CLI::Option* remainder =
      command.add_flag("--remainder", options.remainder,
                       "Beside what has to change something weaker that no effect of the library is, as real machines "
                       "have it; what has to change is still the answer");
  command
      .add_flag("--leave-one-out", options.leave_one_out,
                "Take every effect out of the library in turn; the records are shared among them")
      ->excludes(two)
      ->excludes(several)
      ->excludes(remainder);
  command.add_flag("--position-loop", options.position_loop, "Every wheel is held to an angle by the EPS");
}

void require_out(const BlindOptions& options) {
  if (options.out.empty()) throw CLI::RequiredError("--out");
}

constexpr const char* kFooter =
    "Draws records by an independent simulation and seals their answers, diagnoses them in another process and scores\n"
    "them in a third. DIR then holds blind.html, blind.json and blind.csv, the records, the answers, the sealed key "
    "and\n"
    "the SHA-256 that the key had before the first diagnosis.\n"
    "\n"
    "Examples:\n"
    "  steerid study blind --cases 1000 --seed 7 --out study/blind\n"
    "  steerid study blind --cases 200 --seed 7 --two-effects --out study/pairs\n"
    "  steerid study blind --cases 400 --seed 7 --several --out study/several\n"
    "  steerid study blind draw --cases 20 --seed 7 --out records      only draw, answers open in key.json";

}  // namespace

void add_study_blind(CLI::App& study) {
  CLI::App* blind = study.add_subcommand("blind", "How good the diagnosis is on withheld answers");
  auto options = std::make_shared<BlindOptions>();
  add_options(*blind, *options);
  blind->footer(kFooter);
  blind->require_subcommand(0, 1);
  CLI::App* drawing = blind->add_subcommand("draw", "Only draw records, their answers beside them in key.json");
  CLI::App* sealing = blind->add_subcommand("seal", "First part: draw records and seal their answers");
  CLI::App* scoring = blind->add_subcommand("score", "Last part: open the seal and score the answers");
  add_options(*drawing, *options);
  add_options(*sealing, *options);
  add_out(*scoring, *options);
  for (CLI::App* part : {drawing, sealing, scoring}) add_quiet(*part);
  runs(*blind, [=](FilesOfRun&) {
    require_out(*options);
    if (drawing->parsed()) return draw_openly(*options);
    if (sealing->parsed()) return draw_and_seal(*options);
    if (scoring->parsed()) return score(options->out);
    whole_study(*options);
  });
}

}  // namespace steerid
