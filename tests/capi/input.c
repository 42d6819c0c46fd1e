/* Keys, clicks and menus. */
#include "scene.h"

static void keys_reach_their_handlers_at_the_next_step(void) {
  scene s;
  if (!scene_open(&s)) return;
  CHECK_STATUS(BREVE_OK, breve_world_queue_key(s.world, "a", true));
  CHECK_STATUS(BREVE_OK, breve_world_queue_key(s.world, "a", false));
  CHECK_STATUS(BREVE_OK, breve_world_queue_key(s.world, "left", true));
  CHECK_STATUS(BREVE_OK, breve_world_queue_key(s.world, "z", true)); /* nobody minds */
  CHECK(int_of(&s, "pressed") == 0);
  CHECK_STATUS(BREVE_OK, breve_world_step(s.world));
  CHECK(int_of(&s, "pressed") == 11);
  CHECK(int_of(&s, "released") == 1);
  CHECK_STATUS(BREVE_OK, breve_world_step(s.world));
  CHECK(int_of(&s, "pressed") == 11);
  scene_close(&s);
}

static void no_key_is_refused(void) {
  scene s;
  if (!scene_open(&s)) return;
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_world_queue_key(s.world, "", true));
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_world_queue_key(s.world, "shift", true));
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_world_queue_key(s.world, "ab", true));
  scene_close(&s);
}

static void clicks_name_the_object_or_none(void) {
  scene s;
  if (!scene_open(&s)) return;
  const breve_object ball = ball_of(&s), nothing = {0, 0};
  CHECK_STATUS(BREVE_OK, breve_world_queue_click(s.world, ball));
  CHECK_STATUS(BREVE_OK, breve_world_step(s.world));
  CHECK(int_of(&s, "clicks") == 1);
  CHECK(value_of(&s, "clicked").as.object.index == ball.index);
  CHECK_STATUS(BREVE_OK, breve_world_queue_click(s.world, nothing));
  CHECK_STATUS(BREVE_OK, breve_world_step(s.world));
  CHECK(int_of(&s, "clicks") == 2);
  CHECK(value_of(&s, "clicked").as.object.generation == 0);
  scene_close(&s);
}

static void menu_items_are_listed_and_chosen(void) {
  scene s;
  if (!scene_open(&s)) return;
  const breve_object stage = breve_world_controller(s.world), wanted = value_of(&s, "item").as.object;
  breve_menu_item items[64];
  size_t count = 0, found = 64, separator = 64;
  CHECK_STATUS(BREVE_OK, breve_world_menu_items(s.world, NULL, 0, &count));
  CHECK(count >= 2 && count <= 64);
  CHECK_STATUS(BREVE_OK, breve_world_menu_items(s.world, items, 64, &count));
  for (size_t i = 0; i < count; ++i) {
    if (items[i].item.index == wanted.index) found = i;
    if (items[i].separator && found != 64) separator = i;
  }
  if (CHECK(found < count)) {
    CHECK_TEXT("Choose Me", items[found].title);
    CHECK_TEXT("choose", items[found].method);
    CHECK(items[found].owner.index == stage.index);
    CHECK(items[found].enabled && !items[found].checked && !items[found].separator);
  }
  CHECK(separator < count && strcmp(items[separator].title, "") == 0);
  CHECK_STATUS(BREVE_OK, breve_world_queue_choice(s.world, wanted));
  CHECK_STATUS(BREVE_OK, breve_world_step(s.world));
  CHECK(int_of(&s, "chosen") == 1);
  CHECK_STATUS(BREVE_OK, breve_object_call(s.world, wanted, "disable", NULL, 0, NULL));
  CHECK_STATUS(BREVE_OK, breve_object_call(s.world, wanted, "check", NULL, 0, NULL));
  CHECK_STATUS(BREVE_OK, breve_world_menu_items(s.world, items, 64, &count));
  CHECK(!items[found].enabled && items[found].checked);
  CHECK_STATUS(BREVE_OK, breve_world_queue_choice(s.world, wanted));
  CHECK_STATUS(BREVE_OK, breve_world_step(s.world));
  CHECK(int_of(&s, "chosen") == 1);
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_world_queue_choice(s.world, stage));
  scene_close(&s);
}

static void an_error_in_a_handler_is_reported_and_the_run_goes_on(void) {
  const char* text =
      "@use Control.\nController Touchy.\nControl : Touchy {\n  + to catch-key-x-down: die \"do not press\".\n}\n";
  scene s;
  if (!scene_open_text(&s, text, NULL)) return;
  CHECK_STATUS(BREVE_OK, breve_world_queue_key(s.world, "x", true));
  CHECK_STATUS(BREVE_OK, breve_world_step(s.world));
  CHECK(breve_world_iteration(s.world) == 1);
  CHECK(s.said.errors == 1);
  CHECK(strstr(s.said.error, "do not press") != NULL);
  CHECK(s.said.error[strlen(s.said.error) - 1] == '\n');
  breve_stats stats = breve_stats_default();
  CHECK_STATUS(BREVE_OK, breve_world_stats(s.world, &stats));
  CHECK(stats.errors == 1);
  scene_close(&s);
}

void input_suite(void) {
  RUN(keys_reach_their_handlers_at_the_next_step);
  RUN(no_key_is_refused);
  RUN(clicks_name_the_object_or_none);
  RUN(menu_items_are_listed_and_chosen);
  RUN(an_error_in_a_handler_is_reported_and_the_run_goes_on);
}
