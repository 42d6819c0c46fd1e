// One scene for every shape, material, light, camera and overlay feature.
#include "golden_scenes.hpp"

#include <breve/view.h>

namespace breve::seeing {

namespace {

#define CAMERA "self set-background-color to (.16, .2, .27). self point-camera at (0, 0, 0) from (0, 5, 20). "
#define LIT CAMERA "self enable-lighting. self move-light to (8, 14, 12). "
#define BALL LIT "thing = ((new Thing) become from ball). "
#define CUBE LIT "thing = ((new Thing) become from box). thing rotate around-axis (1, 2, 0) by .6. "
#define SHAPE(shape) LIT "thing = ((new Thing) become from (" shape ")). thing rotate around-axis (1, 0, .5) by .5. "
#define MESH(file, size)                                                        \
  LIT "shape = (new MeshShape load-from-obj file \"" file "\" with-size " #size \
      "). thing = ((new Thing) become from shape). "
#define GROUND BALL "self floor. land catch-shadows. self move-light to (8, 20, 2). "
#define PAIR                                                                                                        \
  LIT "thing = ((new Thing) become from ball at (-3, 0, 0)). other = ((new Thing) become from box at (3, 1, 0) in " \
      "(.2, .6, 1)). "
#define PILE                                                                                                          \
  LIT "self floor. for n = 0, n < 3, n++: { thing = ((new Thing) become from box at (n * 3.2 - 3.2, -.5, 0)). thing " \
      "enable-physics. } thing = ((new Thing) become from ball at (-1.6, 2.6, 0) in (.2, .6, 1)). thing "             \
      "enable-physics. "
#define PEN CAMERA "pen = new Drawing. pen set-line-width to 3. "
#define HILLS                                                                                                          \
  LIT "land = new Terrain. land generate with-height 9. land move to (0, -4, 0). self point-camera at (0, 0, 0) from " \
      "(20, 26, 50). "
#define CELLS LIT "cells = ((new PatchGrid) init-with x-count 4 y-count 4 z-count 4 patch-size (1.6, 1.6, 1.6)). "
#define COLORED                                                                                                        \
  "foreach other in (cells get-patches): { other set-color to ((other get-x-index) / 3.0, (other get-y-index) / 3.0, " \
  "(other get-z-index) / 3.0). other set-transparency to ((other get-x-index) == 2) * .6 + .2. } "
#define FLAT "self set-background-color to (.93, .92, .88). "
#define SHAPES_2D                                                                                                   \
  "(new Thing) become from ball at (-5, 0, 0) in (.85, .35, .1). (new Thing) become from box at (0, 0, 0) in (.1, " \
  ".45, .7). "                                                                                                      \
  "(new Thing) become from ((new PolygonDisk) init-with sides 5 height 1 radius 2) at (5, 0, 0) in (.1, .6, .4). "

constexpr GoldenScene kScenes[] = {
    {"sphere", BALL},
    {"box", CUBE},
    {"disk", SHAPE("(new PolygonDisk) init-with sides 7 height 1.5 radius 3")},
    {"cone", SHAPE("(new PolygonCone) init-with sides 6 height 5 radius 2.5")},
    {"cylinder", SHAPE("(new Cylinder) init-with radius 2 height 4")},
    {"capsule", SHAPE("(new Capsule) init-with radius 1.2 length 4")},
    {"custom_shape",
     LIT "other = new CustomShape. other add-face with-vertex-list {(0, 3, 0), (3, -1, 0), (0, -1, 3)}. "
         "other add-face with-vertex-list {(0, 3, 0), (0, -1, 3), (-3, -1, 0)}. "
         "other add-face with-vertex-list {(0, 3, 0), (-3, -1, 0), (0, -1, -3)}. "
         "other add-face with-vertex-list {(0, 3, 0), (0, -1, -3), (3, -1, 0)}. "
         "other add-face with-vertex-list {(3, -1, 0), (0, -1, 3), (-3, -1, 0), (0, -1, -3)}. "
         "other finish-shape with-density 1. (new Thing) become from other. "},
    {"mesh", MESH("ring.obj", 6) "thing rotate around-axis (1, .4, 0) by .7. "},
    {"mesh_surface_of_two_sides",
     MESH("bowl.obj", 5) "thing move to (-3, 0, 0). thing rotate around-axis (1, 0, 0) by .5. "
                         "other = ((new Thing) become from shape at (4, 0, 0) in (.2, .6, 1)). other rotate "
                         "around-axis (1, 0, 0) by 3.6. "},
    {"mesh_hull",
     LIT "shape = (new MeshShape load-hull file \"ring.obj\" with-size 6). thing = ((new Thing) become from "
         "shape). thing rotate around-axis (1, .4, 0) by .7. "},
    {"mesh_texture",
     MESH("ring.obj", 6) "thing rotate around-axis (1, .4, 0) by .7. thing set-color to (1, 1, 1). thing "
                         "set-texture-image to (self picture of \"checker\"). thing set-texture-scale to 2. "},
    {"mesh_shadow",
     GROUND "shape = (new MeshShape load-from-obj file \"ring.obj\" with-size 5). thing set-shape to shape. "
            "thing move to (0, 2, 0). self enable-shadows. "},
    {"mesh_transparent",
     MESH("ring.obj", 6) "thing set-transparency to .5. (new Thing) become from ball at (0, 0, -5) in "
                         "(.2, .6, 1). "},
    {"mesh_studio_light", MESH("ring.obj", 6) "self disable-lighting. thing rotate around-axis (1, .4, 0) by .7. ", 3,
     true},
    {"scaled_box", CUBE "box scale by (2, .4, 1). "},
    {"terrain", HILLS},
    {"terrain_wireframe", HILLS "land draw-wireframe. "},
    {"plain_colors", PAIR "self disable-lighting. "},
    {"studio_light", PAIR "self disable-lighting. ", 3, true},
    {"texture", CUBE "thing set-texture-image to (self picture of \"checker\"). thing set-texture-scale to 3. "},
    {"texture_of_two_scales",
     CUBE "thing set-texture-image to (self picture of \"checker\"). thing set-texture-scale-x to 6. thing "
          "set-texture-scale-y to 2. "},
    {"texture_with_holes", GROUND
     "self enable-shadows. self move-light to (3, 20, 9). thing move to (-2, 0, -4). other = ((new Thing) become "
     "from box at (1, .5, 2) in (1, .9, .3)). other set-texture-image to (self picture of \"star\"). other "
     "set-texture-scale to 1.5. "},
    {"patterns", LIT
     "for n = 0, n < 6, n++: { thing = ((new Thing) become from box at (4.2 * (n % 3) - 4.2, 4 * (n / 3) - 2, 0) in "
     "(1, 1, 1)). thing set-texture-image to (self picture of ({\"checker\", \"ground\", \"noise\", \"clouds\", "
     "\"sky\", "
     "\"star\"}{n})). thing set-texture-scale to 3. } "},
    {"transparency", PAIR "thing set-transparency to .4. (new Thing) become from ball at (-2, 0, -5) in (0, .8, .3). "
                          "((new Thing) become from ball at (-4, 0, 4) in (.9, .9, .2)) set-transparency to .4. "},
    {"transparency_of_all_kinds", CAMERA
     "for n = 0, n < 2, n++: { thing = ((new Thing) become from box at (n * 5 - 2.5, 0, n * 10 - 5) in (.2, .6, 1)). "
     "thing set-transparency to .6. other = ((new Thing) become from ball at (2.5 - n * 5, -1, n * 6 - 3)). other "
     "set-bitmap-image to (self picture of \"clouds\"). } cells = ((new PatchGrid) init-with x-count 8 y-count 3 "
     "z-count 1 patch-size (1.5, 1.5, 1)). foreach other in (cells get-patches): { other set-color to (1, .6, "
     ".1). other set-transparency to .5. } "},
    {"bitmap", BALL "thing set-bitmap-image to (self picture of \"star\"). thing set-bitmap-heading to .5. "},
    {"light_map", PAIR "thing set-lightmap-image to (self picture of \"star\"). thing move to (2, 1, 3). "},
    {"points", LIT "for n = 0, n < 9, n++: ((new Thing) become from ball at (2 * n - 8, n % 3, 0)) draw-as-point. "},
    {"invisible", PAIR "thing make-invisible. "},
    {"two_lights",
     BALL "thing set-color to (1, 1, 1). self set-light-diffuse-color to (1, .2, .2). self move-light to (-10, 0, 5) "
          "for-light 1. self "
          "set-light-diffuse-color to (.1, .3, 1) for-light 1. self set-light-ambient-color to (0, 0, 0). "},
    {"ambient_light", BALL "self set-light-ambient-color to (.5, .4, .1). self set-light-diffuse-color to (0, 0, 0). "},
    {"specular_light", BALL "self set-light-specular-color to (1, 1, 1). "},
    {"shadow", GROUND "self enable-shadows. "},
    {"shadows_on_small_balls",  // their radii are 3 to 20 pixels
     LIT "self floor. land catch-shadows. self move-light to (8, 20, 30). self enable-shadows. for n = 0, n < 8, n++: "
         "(new Thing) become from ((new Sphere) init-with radius (n * .31 + .38)) at (2.2 * n - 8.2, n * .31 - 1.62 + "
         "n % 2 * 4, 0). "},
    {"shadow_volumes", GROUND "self enable-shadow-volumes. (new Thing) become from box at (4, 4, -3). "},
    {"no_shadow_of_one", GROUND "self enable-shadows. ((new Thing) become from box at (4, 0, 0)) disable-shadows. "},
    {"reflection", GROUND "self enable-reflections. "},
    {"ground_and_sky", GROUND "self enable-shadows. self set-background-color to (.5, .7, 1). ", 3, true},
    {"floor_of_the_library", LIT "new Floor. (new Thing) become from ball at (0, 2, 0). ", 3, true},
    {"fog", LIT "for n = 0, n < 6, n++: (new Thing) become from ball at (n * 3 - 6, 0, -6 * n). self enable-fog. self "
                "set-fog-limits "
                "with-start 15 with-end 50. self set-fog-intensity to .2. "},
    {"fog_of_all_kinds", PEN
     "self enable-fog. self set-fog-limits with-start 15 with-end 60. self set-fog-intensity to .2. self "
     "set-fog-color to (.7, .7, .75). for n = 0, n < 5, n++: { ((new Thing) become from ball at (n * 3 - 8, 0, -8 * "
     "n)) set-bitmap-image to (self picture of \"checker\"). pen set-color to (1, .6, .1). pen draw-line from (n * 3 "
     "- 8, 2, -8 * n) to (n * 3 - 4, 5, -8 * n - 8). pen add-polygon-point at (n * 3 - 8, -2, "
     "-8 * n). pen add-polygon-point at (n * 3 - 6, -2, -8 * n). pen add-polygon-point at (n * 3 - 7, -4, -8 * n). "
     "pen end-polygon. } "},
    {"blur", BALL "thing set-velocity to (40, 0, 0). self enable-blur. self set-blur-factor to .5. ", 3, false, 3},
    {"outline", PAIR "self enable-outline. "},
    {"automatic_camera",
     "self set-background-color to (.5, .7, 1). for n = 0, n < 5, n++: (new Thing) become from ball at (n * 5, n % 2 * "
     "4, n) in "
     "(n / 5.0, .5, 1 - n / 5.0). ",
     3, true},
    {"close_camera", PAIR "self zoom-camera to 9. "},
    {"pitched_camera", PAIR "self pivot-camera x -.6 y .5. "},
    {"cut_by_the_far_plane", GROUND "self set-z-clip to 24. "},
    {"windows", PAIR "eye = new Camera. eye set-size with-height 50 with-width 60. eye set-position with-x 4 with-y 4. "
                     "eye look at (0, 0, 0) "
                     "from (0, 20, 1). eye = new Camera. eye set-size with-height 50 with-width 60. eye set-position "
                     "with-x 96 with-y 66. eye "
                     "look at (3, 1, 0) from (12, 3, 6). "},
    {"light_exposure", PAIR "self set-light-exposure-source to (10, 10, 2). self enable-light-exposure-drawing. "},
    {"background_picture", PAIR "self set-background-texture-image to (self picture of \"clouds\"). "},
    {"sky_box", PAIR "self set-skybox-images to {\"images/clouds.png\", \"images/sky.png\", \"images/checker.png\", "
                     "\"images/noise.png\", "
                     "\"images/sky.png\", \"images/ground.png\"}. self pivot-camera y .6. "},
    {"mountains", PAIR "self set-mountain-skybox. self pivot-camera x .3. ", 3, true},
    {"display_text",
     CAMERA "self set-display-text to \"Agents: 200\" at-x -.9 at-y .8 with-color (1, 1, 1). self set-display-text to "
            "\"\xC3\xA4\xC3\xB6\xC3\xBC \xE2\x89\xA4 5\" at-x -.9 at-y -.8 number 1 with-color (1, .8, .2). "},
    {"large_text", CAMERA
     "self set-display-text-scale to 2. self set-display-text to \"Large\" at-x -.6 at-y 0 with-color (1, 1, 1). "},
    {"graph", CAMERA
     "graph = new Graph. graph set-title to \"waves\". graph set-x-axis-name to \"step\". graph set-y-axis-name to "
     "\"m\". "
     "graph add-line with-color (1, .6, .1). graph add-line with-color (.3, .7, 1). for n = 0, n < 60, n++: { graph "
     "add-point on-line 0 with-value sin(n * .2). graph add-point on-line 1 with-value 2 * cos(n * .1). } "},
    {"labels", PAIR "thing set-label to \"thing\". other set-label to \"other\". "},
    {"boxes_and_axes", PAIR "thing show-bounding-box. other show-axis. other show-bounding-box. "},
    {"lines_between",
     PAIR "thing add-line to other with-color (1, 0, 0) with-style \"--  --  --  --  \". "
          "(new Thing) become from ball at (0, 5, 0). thing set-neighborhood-size to 20. self update-neighbors. "
          "thing show-neighbor-lines. "},
    {"spring", PAIR
     "thing enable-physics. other enable-physics. tie = ((new Spring) connect from thing to other). tie set-pattern to "
     "\"----    ----    \". "},
    {"arrows_contacts", PILE, 3, false, 40, BREVE_ARROWS_CONTACTS, "PhysicalControl"},
    {"arrows_forces", PILE, 3, true, 40, BREVE_ARROWS_FORCES, "PhysicalControl"},
    {"arrows_of_springs_and_velocities",
     PAIR "thing enable-physics. other enable-physics. tie = ((new Spring) connect from thing to other with-length 3 "
          "with-strength 200). thing set-velocity to (0, 4, 0). ",
     3, false, 1, BREVE_ARROWS_FORCES | BREVE_ARROWS_VELOCITIES},
    {"arrows_joints",
     CAMERA
     "body = (new Link). body set-shape to ((new Cube) init-with size (6, 1, 2)). body set-color to (.3, .5, .8). "
     "(new MultiBody) set-root to body. other = (new Link). other set-shape to ((new Cube) init-with size (1, 4, "
     "1)). other set-color to (.8, .6, .3). (new RevoluteJoint) link with-normal (1, 0, 0) with-parent-point (2, "
     "-.5, 0) with-child-point (0, 2, 0) to-child other parent body. thing = (new Link). thing set-shape to "
     "((new Sphere) init-with radius 1). (new FixedJoint) link with-parent-point (-2, .5, 0) with-child-point "
     "(0, -1, 0) to-child thing parent body. ",
     3, false, 0, BREVE_ARROWS_JOINTS, "PhysicalControl"},
    {"drawn_lines", PEN "for n = 1, n < 6, n++: { pen set-color to (1, n / 6.0, .1) with-transparency (1 - n / 8.0). "
                        "pen set-line-width to n. pen "
                        "draw-line from (-6, n * 2 - 6, 0) to (6, n * 2 - 5, 0). } pen set-line-style to \"-  -  \". "
                        "pen draw-line from (-6, 6, "
                        "0) to (6, 6, 0). "},
    {"drawn_polygon", PEN
     "pen set-color to (.2, .7, 1) with-transparency .7. for n = 0, n < 6, n++: pen add-polygon-point at (5 * cos(n * "
     "1.0472), 5 * sin(n * 1.0472), 0). pen end-polygon. "},
    {"turtle", CAMERA "pen = new TurtleDrawing. pen set-line-width to 2. pen set-color to (1, .8, .3). for n = 0, n < "
                      "30, n++: { pen forward "
                      "by n * .25. pen turn-left by 75. } "},
    {"trace",
     LIT "thing = ((new Thing) become from box). thing set-velocity to (20, 6, 0). pen = new Tracer. pen trace agent "
         "thing. ",
     3, false, 4},
    {"cells_volume", CELLS COLORED "self pivot-camera x -.3 y .5. "},
    {"cells_solid", CELLS COLORED "cells disable-volumetric-drawing. self pivot-camera x -.3 y .5. "},
    {"cells_flat",
     CAMERA "cells = ((new PatchGrid) init-with x-count 8 y-count 6 z-count 1 patch-size (1.6, 1.6, 1)). foreach other "
            "in (cells "
            "get-patches): other set-color to ((other get-x-index) / 7.0, (other get-y-index) / 5.0, .4). "},
    {"cells_states",
     "cells = ((new PatchGrid) init-with x-count 16 y-count 12 z-count 1). for n = 0, n < 40, n++: cells set-state to "
     "1 + n % 3 "
     "at-x (n * 7) % 16 at-y (n * 5) % 12. "},
    {"cells_states_in_space", CAMERA
     "cells = ((new PatchGrid) init-with x-count 6 y-count 6 z-count 6). for n = 0, n < 60, n++: cells set-state to 1 "
     "+ n % 3 "
     "at-x (n * 5) % 6 at-y (n * 7) / 6 % 6 at-z n / 12. self pivot-camera x -.3 y .5. self zoom-camera to 14. "},
    {"flat_shapes", FLAT SHAPES_2D, 2},
    {"flat_shapes_with_outlines", FLAT SHAPES_2D, 2, true},
    {"flat_rotation",
     FLAT SHAPES_2D "foreach other in (all Thing): other rotate around-axis (0, 0, 1) by .4. self zoom-camera to 20. ",
     2},
    {"flat_overlap", FLAT SHAPES_2D "(new Thing) become from ball at (1.5, 1.5, 0) in (.9, .8, .2). ", 2, true},
    {"flat_texture",
     FLAT "thing = ((new Thing) become from box in (1, 1, 1)). thing set-texture-image to (self picture of "
          "\"checker\"). thing "
          "set-texture-scale to 3. self zoom-camera to 12. ",
     2},
    {"flat_text_and_labels",
     FLAT SHAPES_2D
     "foreach other in (all Thing): other set-label to \"body\". self set-display-text to \"a flat world\" at-x "
     "-.9 at-y .8. ",
     2},
    {"flat_lines",
     FLAT SHAPES_2D
     "pen = new Drawing. pen set-line-width to 3. pen set-color to (.5, 0, .5). pen draw-line from (-6, -4, 0) to (6, "
     "4, 0). foreach other in (all Thing): other show-bounding-box. ",
     2},
};

}  // namespace

std::span<const GoldenScene> golden_scenes() { return kScenes; }

}  // namespace breve::seeing
