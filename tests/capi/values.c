/* Variables by name, and the values of all types that scripts know. */
#include "scene.h"

static void every_type_is_read(void) {
  scene s;
  if (!scene_open(&s)) return;
  breve_value v = value_of(&s, "count");
  CHECK(v.type == BREVE_TYPE_INT && v.as.integer == 7);
  v = value_of(&s, "level");
  CHECK(v.type == BREVE_TYPE_DOUBLE && v.as.number == 2.5);
  v = value_of(&s, "where");
  CHECK(v.type == BREVE_TYPE_VECTOR && v.as.vector[0] == 1 && v.as.vector[2] == 3);
  v = value_of(&s, "frame");
  CHECK(v.type == BREVE_TYPE_MATRIX && v.as.matrix[0] == 1 && v.as.matrix[4] == 2 && v.as.matrix[8] == 3 &&
        v.as.matrix[1] == 0);
  v = value_of(&s, "name");
  CHECK(v.type == BREVE_TYPE_STRING && v.as.string.size == 5);
  CHECK_TEXT("stage", v.as.string.bytes);
  v = value_of(&s, "blank");
  CHECK(v.type == BREVE_TYPE_OBJECT && v.as.object.generation == 0);
  CHECK(value_of(&s, "things").type == BREVE_TYPE_LIST);
  CHECK(value_of(&s, "table").type == BREVE_TYPE_HASH);
  CHECK_STATUS(BREVE_ERROR_NOT_FOUND, breve_object_get(s.world, breve_world_controller(s.world), "nothing", &v));
  CHECK_STATUS(BREVE_ERROR_UNSUPPORTED, breve_object_get(s.world, breve_world_controller(s.world), "grid", &v));
  scene_close(&s);
}

static void writing_converts_as_an_assignment_does(void) {
  scene s;
  if (!scene_open(&s)) return;
  const breve_object stage = breve_world_controller(s.world), ball = ball_of(&s);
  breve_value v = breve_value_double(3.9);
  CHECK_STATUS(BREVE_OK, breve_object_set(s.world, stage, "count", &v));
  CHECK(int_of(&s, "count") == 3);
  v = breve_value_int(4);
  CHECK_STATUS(BREVE_OK, breve_object_set(s.world, stage, "name", &v));
  CHECK_TEXT("4", value_of(&s, "name").as.string.bytes);
  v = breve_value_vector(7, 8, 9);
  CHECK_STATUS(BREVE_OK, breve_object_set(s.world, stage, "where", &v));
  CHECK(value_of(&s, "where").as.vector[1] == 8);
  const double rows[9] = {1, 2, 3, 4, 5, 6, 7, 8, 9};
  v = breve_value_matrix(rows);
  CHECK_STATUS(BREVE_OK, breve_object_set(s.world, stage, "frame", &v));
  CHECK(value_of(&s, "frame").as.matrix[5] == 6);
  v = breve_value_object(ball);
  CHECK_STATUS(BREVE_OK, breve_object_set(s.world, stage, "blank", &v));
  CHECK(value_of(&s, "blank").as.object.generation == ball.generation);
  v = breve_value_vector(1, 1, 1);
  CHECK_STATUS(BREVE_ERROR_TYPE, breve_object_set(s.world, stage, "count", &v));
  v = breve_value_object(stage);
  CHECK_STATUS(BREVE_ERROR_TYPE, breve_object_set(s.world, stage, "ball", &v)); /* a Ball object only */
  CHECK_STATUS(BREVE_ERROR_NOT_FOUND, breve_object_set(s.world, stage, "nothing", &v));
  CHECK_STATUS(BREVE_ERROR_UNSUPPORTED, breve_object_set(s.world, stage, "grid", &v));
  v.type = 99;
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_object_set(s.world, stage, "count", &v));
  v.type = BREVE_TYPE_POINTER;
  CHECK_STATUS(BREVE_ERROR_UNSUPPORTED, breve_object_set(s.world, stage, "count", &v));
  CHECK(int_of(&s, "count") == 3);
  scene_close(&s);
}

static void a_string_may_hold_zero_bytes_and_be_empty(void) {
  scene s;
  if (!scene_open(&s)) return;
  const breve_object stage = breve_world_controller(s.world);
  breve_value v = breve_value_string(NULL);
  CHECK_STATUS(BREVE_OK, breve_object_set(s.world, stage, "name", &v));
  v = value_of(&s, "name");
  CHECK(v.as.string.size == 0);
  CHECK_TEXT("", v.as.string.bytes);
  v.as.string.bytes = "a\0b";
  v.as.string.size = 3;
  CHECK_STATUS(BREVE_OK, breve_object_set(s.world, stage, "name", &v));
  v = value_of(&s, "name");
  CHECK(v.as.string.size == 3 && memcmp(v.as.string.bytes, "a\0b", 4) == 0);
  v.as.string.bytes = NULL;
  CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_object_set(s.world, stage, "name", &v));
  scene_close(&s);
}

static void lists_are_read_and_made(void) {
  scene s;
  if (!scene_open(&s)) return;
  breve_value list = value_of(&s, "things"), v, inner;
  size_t size = 0;
  CHECK_STATUS(BREVE_OK, breve_list_size(s.world, &list, &size));
  CHECK(size == 4);
  CHECK_STATUS(BREVE_OK, breve_list_get(s.world, &list, 1, &v));
  CHECK(v.type == BREVE_TYPE_DOUBLE && v.as.number == 2.5);
  CHECK_STATUS(BREVE_OK, breve_list_get(s.world, &list, 2, &v));
  CHECK_TEXT("three", v.as.string.bytes);
  CHECK_STATUS(BREVE_OK, breve_list_get(s.world, &list, 3, &inner));
  CHECK_STATUS(BREVE_OK, breve_list_get(s.world, &inner, 1, &v));
  CHECK(v.type == BREVE_TYPE_INT && v.as.integer == 5);
  CHECK_STATUS(BREVE_ERROR_NOT_FOUND, breve_list_get(s.world, &list, 4, &v));

  breve_value made, nested;
  CHECK_STATUS(BREVE_OK, breve_list_create(s.world, &made));
  CHECK_STATUS(BREVE_OK, breve_list_create(s.world, &nested));
  v = breve_value_int(1);
  CHECK_STATUS(BREVE_OK, breve_list_push(s.world, &nested, &v));
  CHECK_STATUS(BREVE_OK, breve_list_push(s.world, &made, &nested));
  v = breve_value_string("last");
  CHECK_STATUS(BREVE_OK, breve_list_push(s.world, &made, &v));
  const breve_keyword keyword = {"value", made};
  breve_value echo;
  CHECK_STATUS(BREVE_OK, breve_object_call(s.world, breve_world_controller(s.world), "echo", &keyword, 1, &echo));
  CHECK_STATUS(BREVE_OK, breve_list_size(s.world, &echo, &size));
  CHECK(size == 2);
  const char* text = NULL;
  CHECK_STATUS(BREVE_OK, breve_value_text(s.world, &echo, &text));
  CHECK_TEXT("{ { 1 }, last }", text);
  scene_close(&s);
}

static void hashes_are_read_and_made(void) {
  scene s;
  if (!scene_open(&s)) return;
  breve_value hash = value_of(&s, "table"), key = breve_value_string("b"), v, keys;
  size_t size = 0;
  CHECK_STATUS(BREVE_OK, breve_hash_size(s.world, &hash, &size));
  CHECK(size == 2);
  CHECK_STATUS(BREVE_OK, breve_hash_get(s.world, &hash, &key, &v));
  CHECK_TEXT("two", v.as.string.bytes);
  key = breve_value_string("c");
  CHECK_STATUS(BREVE_ERROR_NOT_FOUND, breve_hash_get(s.world, &hash, &key, &v));
  CHECK_STATUS(BREVE_OK, breve_hash_keys(s.world, &hash, &keys));
  CHECK_STATUS(BREVE_OK, breve_list_get(s.world, &keys, 0, &v));
  CHECK_TEXT("a", v.as.string.bytes);
  breve_value made, element = breve_value_double(0.5);
  CHECK_STATUS(BREVE_OK, breve_hash_create(s.world, &made));
  key = breve_value_int(3);
  CHECK_STATUS(BREVE_OK, breve_hash_set(s.world, &made, &key, &element));
  const breve_keyword keyword = {"value", made};
  CHECK_STATUS(BREVE_OK, breve_object_call(s.world, breve_world_controller(s.world), "echo-hash", &keyword, 1, &v));
  CHECK_STATUS(BREVE_OK, breve_hash_get(s.world, &v, &key, &element));
  CHECK(element.type == BREVE_TYPE_DOUBLE && element.as.number == 0.5);
  scene_close(&s);
}

static void wrong_and_old_references_are_refused(void) {
  scene s;
  if (!scene_open(&s)) return;
  const breve_object stage = breve_world_controller(s.world);
  breve_value list = value_of(&s, "things"), hash = value_of(&s, "table"), unmade = value_of(&s, "unmade"), v;
  size_t size = 9;
  CHECK_STATUS(BREVE_ERROR_TYPE, breve_list_size(s.world, &hash, &size));
  CHECK_STATUS(BREVE_ERROR_TYPE, breve_hash_size(s.world, &list, &size));
  v = hash;
  v.type = BREVE_TYPE_LIST; /* a lie */
  CHECK_STATUS(BREVE_ERROR_TYPE, breve_list_size(s.world, &v, &size));
  CHECK_STATUS(BREVE_OK, breve_list_size(s.world, &unmade, &size));
  CHECK(size == 0);
  v = breve_value_int(1);
  if (unmade.as.ref.epoch == 0) CHECK_STATUS(BREVE_ERROR_ARGUMENT, breve_list_push(s.world, &unmade, &v));
  v = list;
  v.as.ref.index += 1000;
  CHECK_STATUS(BREVE_ERROR_STALE, breve_list_size(s.world, &v, &size));
  CHECK_STATUS(BREVE_OK, breve_object_call(s.world, stage, "touch", NULL, 0, NULL)); /* script ran */
  CHECK_STATUS(BREVE_ERROR_STALE, breve_list_size(s.world, &list, &size));
  CHECK_STATUS(BREVE_ERROR_STALE, breve_hash_size(s.world, &hash, &size));
  CHECK_STATUS(BREVE_ERROR_STALE, breve_object_set(s.world, stage, "things", &list));
  list = value_of(&s, "things");
  CHECK_STATUS(BREVE_OK, breve_world_step(s.world));
  CHECK_STATUS(BREVE_ERROR_STALE, breve_list_get(s.world, &list, 0, &v));
  scene_close(&s);
}

static void text_is_what_print_shows(void) {
  scene s;
  if (!scene_open(&s)) return;
  const char* text = NULL;
  breve_value v = breve_value_double(2.5);
  CHECK_STATUS(BREVE_OK, breve_value_text(s.world, &v, &text));
  CHECK_TEXT("2.500000", text);
  v = breve_value_vector(1, 2, 3);
  CHECK_STATUS(BREVE_OK, breve_value_text(s.world, &v, &text));
  CHECK_TEXT("(1.00000, 2.00000, 3.00000)", text);
  v = breve_value_object(ball_of(&s));
  CHECK_STATUS(BREVE_OK, breve_value_text(s.world, &v, &text));
  CHECK(text && strncmp(text, "Ball (", 6) == 0);
  scene_close(&s);
}

void values_suite(void) {
  RUN(every_type_is_read);
  RUN(writing_converts_as_an_assignment_does);
  RUN(a_string_may_hold_zero_bytes_and_be_empty);
  RUN(lists_are_read_and_made);
  RUN(hashes_are_read_and_made);
  RUN(wrong_and_old_references_are_refused);
  RUN(text_is_what_print_shows);
}
