// The program, its modules, and the calls of a host that uses all of breve.h.
#include "everything.hpp"

#include <array>
#include <cstring>
#include <string_view>

#include "counted_new.hpp"

namespace limits {

namespace {

struct Module {
  const char* name;
  std::string_view text;
};

constexpr std::string_view kMain = R"tz(
@use Helper.
@include "words.tz".
@path "data".
@define PLACES 6.
Controller Everything.

Control : Everything (aka Everythings) {
	+ variables:
		turns, heard, rung, repeated, bumps, pressed, chosen, clicks (int).
		kept, words, cells (list).
		table (hash).
		title (string).
		picture, plane, diffused, cube, row, note, spinner, tree, camera, entry, drawing (object).
		bag (data).
		frame (matrix).
		grid (4 objects).

	+ to init:
		self set-iteration-step to 0.1.
		self set-integration-step to 0.05.
		entry = (self add-menu named "Choose this entry of the menu" for-method "choose-entry").
		self add-menu-separator.
		PLACES new Walkers.
		(new Post) move to (2.2, 0, 0).
		new Floor.
		note = new Note.
		self make-pictures.
		self make-shapes.
		self observe instance self for-notification "a-turn-has-come" with-method "hear-a-turn".
		note observe instance self for-notification "a-turn-has-come" with-method "hear-a-turn".
		self schedule method-call "ring-once-and-again" at-time 0.25.
		self schedule-repeating method-call "ring-repeatedly" with-interval 0.1.
		self set-display-text to "some text that is longer than a small string" at-x 0.1 number 2.
		self point-camera at (0, 0, 0) from (0, 0, 40).
		self watch item note.
		camera = new Camera.
		camera watch item (new Post).

	+ to make-pictures:
		picture = ((new Image) init-with width 8 height 6).
		picture set-pixel to (1, 0, 1) at-x 3 at-y 2.
		plane = ((new Matrix2D) init-with x-size 5 y-size 5).
		diffused = ((new Matrix2D) init-with x-size 5 y-size 5).
		cube = ((new Matrix3D) init-with x-size 3 y-size 4 z-size 2).
		row = ((new Vector) init-with size 5).
		plane set-value to 1 at-x 2 at-y 2.
		plane set-value to 0.5 at-x 3 at-y 2.

	+ to make-shapes:
		s, t (object).

		s = new CustomShape.
		s add-face with-vertex-list { (1, 1, 1), (-1, -1, 1), (-1, 1, -1) }.
		s add-face with-vertex-list { (1, 1, 1), (1, -1, -1), (-1, -1, 1) }.
		s add-face with-vertex-list { (1, 1, 1), (-1, 1, -1), (1, -1, -1) }.
		s add-face with-vertex-list { (-1, -1, 1), (1, -1, -1), (-1, 1, -1) }.
		s finish-shape with-density 3.
		t = new Mobile.
		t set-shape to s.
		t move to (0, 30, 0).
		(new Stationary) register with-shape ((new Cube) init-with size (1, 2, 3)) at-location (9, 9, 9).
		(new Mobile) set-shape to ((new PolygonDisk) init-with sides 5 height 1 radius 2).
		(new Mobile) set-shape to ((new PolygonCone) init-with sides 6 height 1 radius 2).
		drawing = new TurtleDrawing.
		drawing forward by 2. drawing turn-right by 30. drawing push-state. drawing forward by 1. drawing pop-state.
		t add-line to (new Mobile) with-color (1, 0, 0) with-style "--- - ".

	+ to choose-entry:
		chosen += 1.
	+ to catch-key-a-down:
		pressed += 1.
	+ to click on what (object):
		clicks += 1.
	+ to hear-a-turn from source (object) message m (string):
		heard += |m|.
	+ to ring-once-and-again:
		rung += 1.
		self schedule method-call "ring-once-and-again" at-time ((self get-time) + 0.15).
	+ to ring-repeatedly:
		repeated += 1.

	+ to iterate:
		turns += 1.
		self work-with-lists.
		self work-with-text.
		self work-with-hashes.
		self work-with-grids.
		self make-garbage.
		if turns == 1: self work-with-files.
		if turns == 2: self work-with-archives.
		if turns == 3: self look-around.
		self announce message "a-turn-has-come".
		self update-neighbors.
		super iterate.

	+ to work-with-lists:
		i (int).
		k, m (list).

		for i = 0, i < 20, i++: push (i * 7919) % 31 onto k.
		sort k with by-value.
		prepend -1 onto k. insert 5 at k{4}. remove k{2}. pop k. unprepend k.
		push { 1, { 2, "three" } } onto k.
		m = copylist k.
		push m onto kept.
		if |kept| > 3: unprepend kept.
		cells = all Walkers.
		cells count-a-step.

	+ to by-value this a (int) with b (int):
		return a - b.

	+ to work-with-text:
		s (string).
		i (int).

		for i = 0, i < 6, i++: s = s + "turn $turns of ${title}, word $i. ".
		s{0} = "T".
		title = "the title of turn $turns".
		words = { "some", "words" }.
		push s onto words.
		push { "$self", "$kept", "$frame" } onto words.
		print "turn", turns, (1, 2, 3), kept, table, self, note.
		printf "no line end".

	+ to work-with-hashes:
		i (int).

		for i = 0, i < 12, i++: {
			table{i + turns} = "value number $i".
			table{"key number $i"} = { i, turns }.
		}
		table{(1, 2, i)} = keys(table).
		remove table{turns}.
		frame = [(1, 0, 0), (0, 2, 0), (0, turns, 3)].
		frame = transpose(frame * frame) + frame.
		table::frame = frame.

	+ to work-with-grids:
		diffused compute-diffusion-matrix from plane.
		plane add-values of diffused scaled-by 0.1.
		plane transform with-matrix plane with-result diffused.
		diffused = ((new Matrix2D) init-with x-size 5 y-size 5).
		cube compute-periodic-diffusion-matrix from cube.
		plane copy-to-red-channel of-image picture.
		row set-size to turns + 3.
		picture set-size width (turns + 4) height 6.

	+ to make-garbage:
		a, b (object).
		k (list).
		h (hash).

		a = new Spark. b = new Spark.
		a tie to b. b tie to a.
		push k onto k.
		h{"self"} = h.
		push h onto k.
		grid[turns % 4] = new Spark.
		(new Spark) say-nothing.
		free (new Plain).
		k = 3 new Plains.
		free k.
		self call-method named "by-value" with-arguments { 1, 2 }.
		self call-method named "no-such-method".
		new Complainer.

	+ to work-with-files:
		f (object).

		f = new File.
		f open-for-writing with-file "limits_made.txt".
		f write text "one two three". f write-line text "  four, five". f write text "last". f close.
		f open-for-reading with-file "limits_made.txt".
		words = (f read-line-as-whitespace-delimited-list).
		push (f read-line) onto words. f close.
		f open-for-reading with-file "limits_made.txt".
		bag = (f read-as-data). f close.
		picture write to "limits_made.png".
		picture load from "limits_made.png".
		title = findFile("limits_made.txt").

	+ to work-with-archives:
		copy (object).

		tree = new Note.
		tree::words = { 1, "two", { 3.5, (1, 2, 3) } }.
		tree archive-as-xml file "limits_made.xml".
		copy = (self dearchive-xml file "limits_made.xml").
		push (copy archive-as-xml-string) onto words.
		if copy: free copy.
		note save-to file "limits_note.xml".
		note load-from file "limits_note.xml".

	+ to look-around:
		w (object).

		foreach w in cells: push (w get-neighbors) onto kept.
		self set-background-texture-image to picture.
		w set-texture-image to picture.
		self pan-camera-offset by (1, 0, 0) steps 4.
		title = (self get-type) + (self get-description).
}
)tz";

constexpr std::string_view kHelper = R"tz(
@use Control.
@use Mobile.
Mobile : Walker (aka Walkers) {
	+ variables:
		steps, touched (int).
		seen (list).
	+ to init:
		self move to random[(4, 4, 4)].
		self set-velocity to random[(2, 2, 2)] - (1, 1, 1).
		self set-neighborhood-size to 3.
		self handle-collisions with-type "Post" with-method "touch-a-post".
		self handle-collisions with-type "Walker" with-method "touch-a-walker".
	+ to count-a-step:
		steps += 1.
	+ to touch-a-post with other (object) at place (vector):
		touched += 1.
		push "touched a post $touched times" onto seen.
		return 0.
	+ to touch-a-walker with other (object):
		touched += 1.
	+ to iterate:
		seen = (self get-neighbors).
		self set-rotational-velocity to (0, 1, 0).
}
Stationary : Post (aka Posts) { }
)tz";

constexpr std::string_view kWords = R"tz(
Object : Spark (aka Sparks) {
	+ variables:
		other (object).
		things (list).
	+ to init:
		self enable-auto-free.
		push "a spark" onto things.
	+ to tie to o (object):
		other = o.
		push o onto things.
	+ to say-nothing:
		return 0.
	+ to destroy:
		things = { "gone" }.
}
Object : Plain (aka Plains) {
	+ variables:
		text (string).
	+ to init:
		text = "plain " + "text".
}
Object : Complainer {
	+ to init:
		self enable-auto-free.
	+ to destroy:
		die "on purpose".
}
Data : Note (aka Notes) {
	+ variables:
		words (list).
		number (int).
	+ to hear-a-turn:
		number += 1.
	+ to give text t (string) twice n = 2 (int):
		push t onto words.
		return { t, n }.
}
)tz";

constexpr std::array<Module, 3> kModules{{{"everything.tz", kMain}, {"Helper.tz", kHelper}, {"words.tz", kWords}}};

bool resolve(void*, const char* name, const char*, breve_module* module) {
  for (const Module& m : kModules) {
    if (std::strcmp(m.name, name) != 0) continue;
    module->text = m.text.data();
    module->size = m.text.size();
    return true;
  }
  return false;
}

#define TRY(call_of_host)                     \
  do {                                        \
    run.status = (call_of_host);              \
    run.call = #call_of_host;                 \
    run.line = __LINE__;                      \
    if (run.status != BREVE_OK) return false; \
  } while (false)

bool make_world(Run& run) {
  breve_world_config config = breve_world_config_default();
  static const char* const arguments[] = {"everything.tz", "an argument that is not short at all"};
  config.arguments = arguments;
  config.argument_count = 2;
  TRY(breve_world_create(run.runtime, run.program, &config, &run.world));
  return true;
}

bool make_program(Run& run) {
  if (run.runtime == nullptr) {
    breve_runtime_config config = counted_config();
    config.resolve_module = resolve;
    config.print = [](void*, breve_world*, breve_channel, const char*, std::size_t) {};
    config.add_path = [](void*, const char*) {};
    config.find_file = [](void*, breve_world*, const char* name, breve_write_fn write, void* sink) {
      write(sink, name, std::strlen(name));
      return true;
    };
    TRY(breve_runtime_create(&config, &run.runtime));
  }
  TRY(breve_program_load(run.runtime, "everything.tz", &run.program));
  return true;
}

bool use_values(Run& run) {
  breve_world* world = run.world;
  const breve_object controller = breve_world_controller(world);
  breve_value list, hash, element, keys;
  std::size_t size = 0;
  TRY(breve_list_create(world, &list));
  for (int i = 0; i < 5; ++i) {
    element = breve_value_string("an element that is a string of some length");
    TRY(breve_list_push(world, &list, &element));
  }
  TRY(breve_list_get(world, &list, 3, &element));
  TRY(breve_hash_create(world, &hash));
  for (int i = 0; i < 9; ++i) {
    const breve_value key = breve_value_int(i);
    TRY(breve_hash_set(world, &hash, &key, &list));
  }
  TRY(breve_hash_keys(world, &hash, &keys));
  TRY(breve_list_size(world, &keys, &size));
  TRY(breve_object_set(world, controller, "table", &hash));
  TRY(breve_object_get(world, controller, "table", &hash));
  element = breve_value_string("a title set by the host, longer than most");
  TRY(breve_object_set(world, controller, "title", &element));
  TRY(breve_object_get(world, controller, "frame", &element));
  TRY(breve_object_get(world, controller, "words", &element));
  const char* text = nullptr;
  TRY(breve_value_text(world, &element, &text));
  return true;
}

bool use_calls(Run& run) {
  breve_world* world = run.world;
  const breve_object controller = breve_world_controller(world);
  breve_value note, result;
  TRY(breve_object_get(world, controller, "note", &note));
  const breve_keyword keyword{"text", breve_value_string("what the host gives to the note")};
  TRY(breve_object_call(world, note.as.object, "give", &keyword, 1, &result));
  const char* const names[] = {"text", "twice"};
  breve_selector selector;
  TRY(breve_world_prepare(world, "give", names, 2, &selector));
  const breve_value arguments[] = {keyword.value, breve_value_int(3)};
  TRY(breve_object_call_prepared(world, note.as.object, selector, arguments, 2, &result));
  TRY(breve_object_call(world, controller, "work-with-text", nullptr, 0, nullptr));
  TRY(breve_world_key(world, "a", true));
  TRY(breve_world_key(world, "left", false));
  TRY(breve_world_click(world, note.as.object));
  breve_menu_item items[4];
  std::size_t count = 0;
  TRY(breve_world_menu_items(world, items, 4, &count));
  TRY(breve_world_choose(world, items[0].item));
  return true;
}

bool use_objects(Run& run) {
  breve_world* world = run.world;
  breve_object walkers[16], made;
  std::size_t count = 0;
  TRY(breve_world_objects(world, "Walkers", walkers, 16, &count));
  TRY(breve_object_create(world, "Walker", &made));
  breve_pose pose;
  TRY(breve_object_pose(world, made, &pose));
  pose.location[0] = 1;
  pose.rotation[1] = 0.5;
  TRY(breve_object_set_pose(world, made, &pose));
  const double one[4] = {1, 0.5, 0.25, 0.5};
  TRY(breve_object_set_velocity(world, made, one));
  TRY(breve_object_set_rotational_velocity(world, made, one));
  TRY(breve_object_set_color(world, made, one));
  TRY(breve_world_step(world));
  TRY(breve_object_free(world, made));
  TRY(breve_object_create(world, "Spark", &made));
  return true;
}

bool use_images(Run& run) {
  static std::array<unsigned char, 1 << 20> image;
  std::size_t size = 0;
  std::uint64_t hash = 0;
  TRY(breve_world_snapshot(run.world, image.data(), image.size(), &size));
  TRY(breve_world_hash(run.world, &hash));
  TRY(breve_world_step(run.world));
  TRY(breve_world_restore(run.world, image.data(), size));
  breve_world_config config = breve_world_config_default();
  TRY(breve_world_create(run.runtime, run.program, &config, &run.second));
  TRY(breve_world_restore(run.second, image.data(), size));
  TRY(breve_world_step(run.second));
  breve_effect effects[32];
  std::size_t count = 0;
  TRY(breve_world_effects(run.world, effects, 32, &count));
  breve_stats stats{};
  stats.struct_size = sizeof stats;
  TRY(breve_world_stats(run.world, &stats));
  return true;
}

bool step(Run& run, int times) {
  for (int i = 0; i < times; ++i) TRY(breve_world_step(run.world));
  return true;
}

}  // namespace

bool run_a_little(Run& run) { return make_program(run) && make_world(run) && step(run, 2); }

bool run_everything(Run& run) {
  if (!make_program(run) || !make_world(run) || !step(run, 8)) return false;
  if (!use_values(run) || !use_calls(run) || !use_objects(run) || !use_images(run)) return false;
  TRY(breve_world_advance(run.world, 0.35, nullptr));
  return true;
}

void end_run(Run& run) {
  breve_world_destroy(run.world);
  breve_world_destroy(run.second);
  breve_program_destroy(run.program);
  run.world = run.second = nullptr;
  run.program = nullptr;
}

}  // namespace limits
