#include "commands.h"
#include "commands/mode.h"
#include "query/output.h"
#include "write/json_output.h"

#include <tendril/base/file.h>

#include <algorithm>
#include <iostream>

namespace tendril::runner {
namespace {

struct CollideArguments {
  std::string mesh, queries, out;
  Posing posing;
  ModeFlags mode;
  bool json = false;
};

/// What was found, for both kinds of readers.
struct Told {
  OrderedJson json;
  std::string table;
  std::size_t undecidable = 0;
};

Told tell(Target& target, const scene::Queries& queries) {
  const std::vector<Finding> findings = ask(target, queries);
  const auto undecidable = std::count_if(findings.begin(), findings.end(), [](const Finding& f) {
    return f.answer.relation == exact::Relation::undecidable;
  });
  return {to_json(target, findings), to_table(target, findings), static_cast<std::size_t>(undecidable)};
}

Told tell(Target& target, Target& other) {
  const MeshFinding found = ask(target, other);
  const auto open = [](const std::optional<Parts>& parts) { return parts ? parts->undecidable : 0; };
  return {to_json(target, other, found), to_table(target, other, found),
          open(found.parts_of_other) + open(found.parts_of_target)};
}

Told carry_out(const CollideArguments& options) {
  Posing posing = options.posing;
  posing.mode = options.mode.mode();
  if (is_json(options.queries)) {
    const scene::Queries queries = scene::read_queries(options.queries);
    Target target = read_target(options.mesh, posing);
    return tell(target, queries);
  }
  Target target = read_target(options.mesh, posing), other = read_target(options.queries, {});
  return tell(target, other);
}

int collide(const CollideArguments& options) {
  const Told told = carry_out(options);
  if (!options.out.empty()) write_file_whole(options.out, told.json.dump(2) + "\n");
  if (options.json) {
    print(told.json);
  } else {
    std::cout << told.table;
  }
  if (told.undecidable == 0) return kDone;
  std::cerr << "tendril: " << told.undecidable << " undecidable: the surface is open\n";
  return kNoSuccess;
}

}  // namespace

Command collide_command(CLI::App& parent) {
  auto* app = parent.add_subcommand("collide",
                                    "What meets a mesh, exactly: points, balls, segments, triangles, "
                                    "or a second mesh");
  const auto options = std::make_shared<CollideArguments>();
  app->add_option("mesh", options->mesh, "scene file (JSON) with a mesh, or a mesh (OFF, PLY, OBJ, STL)")
      ->required();
  app->add_option("queries", options->queries, "file of queries (JSON), or a mesh (OFF, PLY)")->required();
  app->add_option("--pose", options->posing.pose,
                  "curve file (JSON): the scene's curve-pairs posed, or those of --axis");
  app->add_option("--axis", options->posing.axis, "curve file (JSON) that a mesh alone is bound to, at rest");
  options->mode.add_to(*app);
  app->add_option("--out", options->out, "file to write the JSON to");
  app->add_flag("--json", options->json, "print JSON");
  return {app, [options] { return collide(*options); }};
}

}  // namespace tendril::runner
