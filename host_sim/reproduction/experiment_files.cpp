#include "reproduction/experiment_files.hpp"

#include <system_error>

#include "log/bad_input.hpp"
#include "log/whole_file.hpp"

namespace steerid {

void write_experiment(const std::filesystem::path& folder, const ExperimentResults& results) {
  const std::string json = experiment_json(results);
  const std::string html = report::html(experiment_page(results));
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) {
    throw bad_input({.file = folder.string(),
                     .expected = "a folder that can be made",
                     .found = error.message(),
                     .advice = "give --out another place"});
  }
  WholeFile json_file(folder / "experiment.json");
  WholeFile html_file(folder / "report.html");
  json_file.write(json);
  html_file.write(html);
  json_file.commit();
  html_file.commit();
}

}  // namespace steerid
