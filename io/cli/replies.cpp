#include "io/cli/replies.h"

#include <CLI/CLI.hpp>

#include "geometry/errors.h"
#include "io/results/json_parts.h"

namespace isorim::cli {
namespace {

using io::Json;

Json reply() {
  return {{"isorim", io::program_version()}};
}

Json text_or_null(const std::string& text) {
  return text.empty() ? Json(nullptr) : Json(text);
}

const char* kind_of(const std::exception& error) {
  if (dynamic_cast<const GeometryError*>(&error)) return "geometry";
  if (dynamic_cast<const InputError*>(&error)) return "input";
  return dynamic_cast<const NumericalError*>(&error) ? "numerical" : "internal";
}

Json argument_json(const CLI::Option& option) {
  Json names = Json::array();
  if (option.get_positional()) names.push_back(option.get_name(true));
  for (const std::string& name : option.get_snames()) names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) names.push_back("--" + name);
  const bool takes_value = option.get_items_expected_max() > 0;
  return {{"names", std::move(names)},
          {"text", option.get_description()},
          {"value", takes_value ? text_or_null(option.get_type_name()) : Json(nullptr)},
          {"required", option.get_required()}};
}

Json command_json(const CLI::App& command) {
  Json json{{"name", command.get_name()}, {"text", command.get_description()}, {"arguments", Json::array()}};
  for (const CLI::Option* option : command.get_options()) json["arguments"].push_back(argument_json(*option));
  const auto inner = command.get_subcommands([](const CLI::App*) { return true; });
  if (!inner.empty()) json["commands"] = Json::array();
  for (const CLI::App* one : inner) json["commands"].push_back(command_json(*one));
  return json;
}

Json key_json(const io::KeyDescription& key) {
  return {{"name", key.name},
          {"type", key.type},
          {"text", key.text},
          {"unit", text_or_null(key.unit)},
          {"range", text_or_null(key.range_text)},
          {"default", text_or_null(key.default_text)},
          {"choices", key.choices.empty() ? Json(nullptr) : Json(key.choices)},
          {"required", key.presence == io::Presence::required}};
}

}  // namespace

std::string failure_json(const std::exception& error, int exit_status) {
  Json json = reply();
  json["error"] = {{"kind", kind_of(error)}, {"message", error.what()}, {"exit_status", exit_status}};
  return io::json_text(json);
}

std::string conversion_json(const ConvertArguments& arguments, const io::Conversion& conversion,
                            const std::vector<std::string>& warnings) {
  Json json = reply();
  json["input"] = arguments.input.string();
  json["output"] = arguments.output.string();
  json["format"] = io::format_name(conversion.format);
  switch (conversion.format) {
    case io::BoundaryFormat::iges:
      json["solids"] = conversion.solids;
      json["solid_faces"] = conversion.solid_faces;
      json["loose_faces"] = conversion.loose_faces;
      json["curves"] = conversion.curves;
      json["unit"] = conversion.unit;
      break;
    case io::BoundaryFormat::iga:
      json["functions"] = conversion.functions;
      [[fallthrough]];
    case io::BoundaryFormat::vtu:
      json["elements"] = conversion.elements;
      break;
    case io::BoundaryFormat::stl:
      json["triangles"] = conversion.triangles;
      break;
    case io::BoundaryFormat::svg:
      break;
  }
  json["warnings"] = warnings;
  return io::json_text(json);
}

std::string picture_json(const PictureArguments& arguments, const io::picture::PictureOptions& options) {
  Json json = reply();
  json["inputs"] = Json::array();
  for (const std::filesystem::path& input : arguments.inputs) json["inputs"].push_back(input.string());
  json["output"] = arguments.output.string();
  json["width"] = options.width;
  json["height"] = options.height;
  json["views"] = Json::array();
  for (const io::picture::View& view : options.views) json["views"].push_back(view.name);
  json["field"] = options.field ? Json(options.field->name) : Json(nullptr);
  json["component"] = options.field ? text_or_null(options.field->component) : Json(nullptr);
  return io::json_text(json);
}

std::string hulls_json(const std::filesystem::path& library, const std::vector<io::HullEntry>& hulls) {
  Json json = reply();
  json["library"] = library.string();
  json["hulls"] = Json::array();
  for (const io::HullEntry& hull : hulls) {
    json["hulls"].push_back({{"name", hull.name},
                             {"title", hull.title},
                             {"source", hull.source},
                             {"length", io::number(hull.length)},
                             {"beam", io::number(hull.beam)},
                             {"draught", io::number(hull.draught)},
                             {"stations", hull.stations},
                             {"waterlines", hull.waterlines}});
  }
  return io::json_text(json);
}

std::string hull_json(const std::string& action, const std::filesystem::path& library, const std::string& name,
                      const std::filesystem::path& file) {
  Json json = reply();
  json["library"] = library.string();
  json[action] = name;
  if (!file.empty()) json["file"] = file.string();
  return io::json_text(json);
}

std::string commands_json(const CLI::App& app, const std::string& name) {
  Json json = reply();
  json["commands"] = Json::array();
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
    if (name.empty() || command->get_name() == name) json["commands"].push_back(command_json(*command));
  }
  return io::json_text(json);
}

std::string tables_json(const std::vector<const io::Description*>& tables) {
  Json json = reply();
  json["tables"] = Json::array();
  for (const io::Description* table : tables) {
    Json keys = Json::array();
    for (const io::KeyDescription& key : table->keys) keys.push_back(key_json(key));
    json["tables"].push_back({{"name", table->name}, {"text", table->text}, {"keys", std::move(keys)}});
  }
  return io::json_text(json);
}

}  // namespace isorim::cli
