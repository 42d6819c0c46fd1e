/* Runs the suite that is named on the command line. */
#include "check.h"

void analysis_suite(void);
void batch_suite(void);
void budget_suite(void);
void bulk_suite(void);
void calls_suite(void);
void classes_suite(void);
void config_suite(void);
void errors_suite(void);
void evaluate_suite(void);
void events_suite(void);
void filters_suite(void);
void forces_suite(void);
void physics_budget_suite(void);
void files_suite(void);
void functions_suite(void);
void images_suite(void);
void input_suite(void);
void interpolation_suite(void);
void moments_suite(void);
void nulls_suite(void);
void objects_suite(void);
void profile_suite(void);
void program_suite(void);
void queries_suite(void);
void reentry_suite(void);
void reentry_all_suite(void);
void reload_suite(void);
void snapshot_suite(void);
void flat_suite(void);
void grids_suite(void);
void solid_suite(void);
void stepping_suite(void);
void threads_suite(void);
void user_data_suite(void);
void values_suite(void);
void settings_suite(void);
void setters_suite(void);
void scene_rows_suite(void);
void view_suite(void);
void plugins_suite(void);
void recording_suite(void);
void debug_draw_suite(void);
void sound_suite(void);
void network_suite(void);
void network_peers_suite(void);
void learning_suite(void);
void listener_suite(void);
void contact_force_suite(void);

static const struct {
  const char* name;
  void (*run)(void);
} suites[] = {
    /* clang-format off */
    {"analysis", analysis_suite},
    {"batch", batch_suite},
    {"budget", budget_suite},
    {"bulk", bulk_suite},
    {"calls", calls_suite},
    {"classes", classes_suite},
    {"config", config_suite},
    {"errors", errors_suite},
    {"evaluate", evaluate_suite},
    {"events", events_suite},
    {"filters", filters_suite},
    {"forces", forces_suite},
    {"physics_budget", physics_budget_suite},
    {"files", files_suite},
    {"functions", functions_suite},
    {"images", images_suite},
    {"input", input_suite},
    {"interpolation", interpolation_suite},
    {"moments", moments_suite},
    {"nulls", nulls_suite},
    {"objects", objects_suite},
    {"profile", profile_suite},
    {"program", program_suite},
    {"queries", queries_suite},
    {"reentry", reentry_suite},
    {"reentry_all", reentry_all_suite},
    {"reload", reload_suite},
    {"snapshot", snapshot_suite},
    {"flat", flat_suite},
    {"grids", grids_suite},
    {"solid", solid_suite},
    {"stepping", stepping_suite},
    {"threads", threads_suite},
    {"user_data", user_data_suite},
    {"plugins", plugins_suite},
    {"recording", recording_suite},
    {"debug_draw", debug_draw_suite},
    {"sound", sound_suite},
    {"network", network_suite},
    {"network_peers", network_peers_suite},
    {"learning", learning_suite},
    {"listener", listener_suite},
    {"contact_force", contact_force_suite},
    {"values", values_suite},
    {"settings", settings_suite},
    {"setters", setters_suite},
    {"scene_rows", scene_rows_suite},
    {"view", view_suite},
    /* clang-format on */
};

int main(int argc, char** argv) {
  int ran = 0;
  for (size_t i = 0; i < sizeof suites / sizeof *suites; ++i) {
    if (argc > 1 && strcmp(argv[1], suites[i].name) != 0) continue;
    suites[i].run();
    ++ran;
  }
  if (ran == 0) printf("there is no such suite\n");
  if (failures != 0) printf("%d checks failed\n", failures);
  return ran == 0 || failures != 0;
}
