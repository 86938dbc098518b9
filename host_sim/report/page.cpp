// SPDX-FileCopyrightText: 2026 the steerid authors
// SPDX-License-Identifier: Apache-2.0

#include "report/page.hpp"

#include <nlohmann/json.hpp>
#include <string_view>

#include "log/whole_file.hpp"
#include "report/bundle.hpp"
#include "report/document.hpp"
#include "report/escaped.hpp"

namespace steerid::report {
namespace {

/// In JSON a '<' stands in strings only, and there it may be written as an escape: no "</script>" or "<!--" is left.
std::string unbreakable(const std::string& text) {
  std::string out;
  out.reserve(text.size() + text.size() / 64);
  for (const char c : text) {
    if (c == '<') {
      out += "\\u003c";
    } else {
      out += c;
    }
  }
  return out;
}

/// UTF-8 as the JSON library repairs it: what is not UTF-8 becomes U+FFFD.
std::string valid_utf8(const std::string& text) {
  return nlohmann::json::parse(nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace))
      .get<std::string>();
}

}  // namespace

std::string document_json(const Page& page) {
  nlohmann::json document = {{"schema", "steerid.report/1"}, {"title", page.title}, {"parts", nlohmann::json::array()}};
  if (!page.subtitle.empty()) document["subtitle"] = page.subtitle;
  if (!page.footer.empty()) document["footer"] = page.footer;
  for (const Part& part : page.parts) document["parts"].push_back(to_document(part));
  return document.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

std::string html(const Page& page) {
  // The build of the bundle has checked that each mark occurs once, the title's first.
  constexpr std::string_view kTitle = "@STEERID_TITLE@";
  constexpr std::string_view kDocument = "@STEERID_DOCUMENT@";
  const std::string_view bundle = page_bundle();
  const std::size_t title_at = bundle.find(kTitle);
  const std::size_t document_at = bundle.find(kDocument);
  const std::size_t between = title_at + kTitle.size();
  const std::string document = unbreakable(document_json(page));
  std::string out;
  out.reserve(bundle.size() + document.size() + page.title.size());
  out += bundle.substr(0, title_at);
  out += escaped(valid_utf8(page.title));
  out += bundle.substr(between, document_at - between);
  out += document;
  out += bundle.substr(document_at + kDocument.size());
  return out;
}

void write_page(const std::filesystem::path& path, const Page& page) { write_whole_file(path, html(page)); }

}  // namespace steerid::report
