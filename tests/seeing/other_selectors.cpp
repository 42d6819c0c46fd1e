// Selectors of images, drawings, lines, springs and grids.
#include "selectors.hpp"

namespace breve::seeing {

namespace {

#define VIEW "self point-camera at (0, 0, 0) from (0, 0, 20). "
#define PEN VIEW "pen = new Drawing. pen set-color to (1, 0, 0). pen set-line-width to 4. "
#define LINED PEN "pen draw-line from (-5, 0, 0) to (5, 0, 0). "
#define TURTLE VIEW "pen = new TurtleDrawing. pen set-line-width to 4. pen hide-turtle. "
#define PAIR \
  VIEW "thing = ((new Thing) become from ball at (-4, 0, 0)). other = ((new Thing) become from ball at (4, 0, 0)). "
#define TIED PAIR "tie = new Line. tie connect from thing to other with-color (1, 0, 0). "
#define SPRUNG PAIR "thing enable-physics. other enable-physics. tie = ((new Spring) connect from thing to other). "
#define CUBE VIEW "thing = ((new Thing) become from box in (1, 1, 1)). thing set-texture-scale to 3. "
#define PAINTED CUBE "picture = ((new Image) init-with width 4 height 4). thing set-texture-image to picture. "
#define PLOT VIEW "graph = new Graph. graph add-line with-color (1, 0, 0). "
#define EACH "for n = 0, n < 16, n++: picture "
#define AT " at-x (n % 4) at-y (n / 4)."
#define MATRIX "other = ((new Matrix2D) init-with x-size 4 y-size 4). other set-all-values to .9. "
#define FIELD PAINTED MATRIX
#define SHOWN \
  CUBE MATRIX "picture = ((new MatrixImage) init-with the-matrix other). thing set-texture-image to picture. "
#define ROW "other = ((new Vector) init-with size 16). for n = 0, n < 16, n++: other set-value to .9 at n. "
#define LISTED CUBE ROW "picture = ((new VectorImage) init-with the-vector other). thing set-texture-image to picture. "
#define CELLS VIEW "cells = ((new PatchGrid) init-with x-count 4 y-count 4 z-count 4 patch-size (2, 2, 2)). "
#define ONE "(cells get-patch-at x 1 y 1 z 3) "
#define SMELL                                                                                               \
  CELLS                                                                                                     \
  "chemical = ((new PatchChemical) init-with diffusion-rate .1 decay-rate .1). cells track patch-chemical " \
  "chemical. "                                                                                              \
  "for n = 0, n < 4, n++: cells set-concentration of chemical at-x n at-y 1 at-z 3 to .9. "
#define SOLID                                                                                   \
  CELLS                                                                                         \
  "field = ((new Matrix3D) init-with x-size 4 y-size 4 z-size 4). field set-all-values to .9. " \
  "foreach other in (cells get-patches): { other set-color to (.2, .2, .2). other set-transparency to .3. } "
#define SLICE PAINTED "field = ((new Matrix3D) init-with x-size 4 y-size 4 z-size 4). field set-all-values to .9. "

constexpr Selector kOthers[] = {
    {"Graph add-line", VIEW "graph = new Graph. ", "graph add-line with-color (1, 0, 0)."},
    {"Graph add-point", PLOT, "for n = 0, n < 9, n++: graph add-point on-line 0 with-value n * n."},
    {"Graph set-title", PLOT, "graph set-title to \"squares\"."},
    {"Graph set-x-axis-name", PLOT, "graph set-x-axis-name to \"number\"."},
    {"Graph set-y-axis-name", PLOT, "graph set-y-axis-name to \"its square\"."},
    {"Image load", PAINTED, "picture load from \"images/checker.png\"."},
    {"Image set-size", PAINTED "picture load from \"images/checker.png\". ", "picture set-size width 4 height 4."},
    {"Image set-pixel", PAINTED, EACH "set-pixel to (1, 1, 0)" AT},
    {"Image set-rgb-pixel", PAINTED, EACH "set-rgb-pixel to (1, 1, 0)" AT},
    {"Image set-red-pixel", PAINTED, EACH "set-red-pixel to 1" AT},
    {"Image set-green-pixel", PAINTED, EACH "set-green-pixel to 1" AT},
    {"Image set-blue-pixel", PAINTED, EACH "set-blue-pixel to 1" AT},
    {"Image set-alpha-pixel", PAINTED, EACH "set-alpha-pixel to 0" AT},
    {"Image read-pixels", PAINTED "picture set-size width 64 height 64. ", "picture read-pixels at-x 300 at-y 10."},
    {"Image read-depth", PAINTED "picture set-size width 64 height 64. ",
     "picture read-depth at-x 300 at-y 200 linearize 1 max-dist 20."},
    {"Matrix2D copy-to-red-channel", FIELD, "other copy-to-red-channel of-image picture."},
    {"Matrix2D copy-to-green-channel", FIELD, "other copy-to-green-channel of-image picture."},
    {"Matrix2D copy-to-blue-channel", FIELD, "other copy-to-blue-channel of-image picture."},
    {"Matrix3D copy-slice-to-red-channel", SLICE, "field copy-slice-to-red-channel z-plane 1 of-image picture."},
    {"Matrix3D copy-sliced-to-green-channel", SLICE, "field copy-sliced-to-green-channel z-plane 1 of-image picture."},
    {"Matrix3D copy-slice-to-blue-channel", SLICE, "field copy-slice-to-blue-channel z-plane 1 of-image picture."},
    {"Matrix3D copy-slice-to-alpha-channel", SLICE "field set-all-values to 0. ",
     "field copy-slice-to-alpha-channel z-plane 1 of-image picture."},
    {"Matrix3D copy-to-red-channel", SOLID, "field copy-to-red-channel of-patch-grid cells."},
    {"Matrix3D copy-to-green-channel", SOLID, "field copy-to-green-channel of-patch-grid cells."},
    {"Matrix3D copy-to-blue-channel", SOLID, "field copy-to-blue-channel of-patch-grid cells."},
    {"Matrix3D copy-to-alpha-channel", SOLID, "field copy-to-alpha-channel of-patch-grid cells."},
    {"MatrixImage set-red", SHOWN, "picture set-red to other.", 1},
    {"MatrixImage set-green", SHOWN, "picture set-green to other.", 1},
    {"MatrixImage set-blue", SHOWN, "picture set-blue to other.", 1},
    {"MatrixImage set-scale-to-max-value", SHOWN "picture set-red to other. other set-all-values to .2. ",
     "picture set-scale-to-max-value of other.", 1},
    {"MatrixImage set-red-scale-to-max-value", SHOWN "picture set-red to other. other set-all-values to .2. ",
     "picture set-red-scale-to-max-value.", 1},
    {"MatrixImage set-green-scale-to-max-value", SHOWN "picture set-green to other. other set-all-values to .2. ",
     "picture set-green-scale-to-max-value.", 1},
    {"MatrixImage set-blue-scale-to-max-value", SHOWN "picture set-blue to other. other set-all-values to .2. ",
     "picture set-blue-scale-to-max-value.", 1},
    {"Vector copy-to-red-channel", PAINTED ROW, "other copy-to-red-channel of-image picture."},
    {"Vector copy-to-green-channel", PAINTED ROW, "other copy-to-green-channel of-image picture."},
    {"Vector copy-to-blue-channel", PAINTED ROW, "other copy-to-blue-channel of-image picture."},
    {"VectorImage set-red", LISTED, "picture set-red to other.", 1},
    {"VectorImage set-green", LISTED, "picture set-green to other.", 1},
    {"VectorImage set-blue", LISTED, "picture set-blue to other.", 1},
    {"Drawing draw-line", PEN, "pen draw-line from (-5, 0, 0) to (5, 0, 0)."},
    {"Drawing add-line-point", PEN, "pen add-line-point at (-5, 0, 0). pen add-line-point at (5, 2, 0)."},
    {"Drawing add-polygon-point", PEN,
     "pen add-polygon-point at (-5, 0, 0). pen add-polygon-point at (5, 0, 0). pen add-polygon-point at (0, 4, 0)."},
    {"Drawing end-polygon",
     PEN
     "pen add-polygon-point at (-5, 0, 0). pen add-polygon-point at (5, 0, 0). pen add-polygon-point at (0, 4, 0). ",
     "pen end-polygon. pen add-polygon-point at (0, -5, 0). pen add-polygon-point at (5, -5, 0). "
     "pen add-polygon-point at (5, -1, 0)."},
    {"Drawing clear", LINED, "pen clear."},
    {"Drawing set-instruction-limit", LINED,
     "pen set-instruction-limit to 1. pen draw-line from (0, -4, 0) to (0, 4, 0)."},
    {"Drawing set-line-style", PEN,
     "pen set-line-style to \"--  --  --  --  \". pen draw-line from (-5, 0, 0) to (5, 0, 0)."},
    {"Drawing set-line-width", PEN, "pen set-line-width to 9. pen draw-line from (-5, 0, 0) to (5, 0, 0)."},
    {"Drawing set-color", PEN, "pen set-color to (0, 0, 1). pen draw-line from (-5, 0, 0) to (5, 0, 0)."},
    {"Drawing destroy", LINED, "free pen."},
    {"Tracer trace", VIEW "thing = ((new Thing) become from ball). thing set-velocity to (20, 0, 0). ",
     "pen = new Tracer. pen trace agent thing.", 5},
    {"TurtleDrawing forward", TURTLE, "pen forward by 5."},
    {"TurtleDrawing back", TURTLE, "pen back by 5."},
    {"TurtleDrawing turn-up", TURTLE, "pen turn-up by 60. pen forward by 5."},
    {"TurtleDrawing turn-down", TURTLE, "pen turn-down by 60. pen forward by 5."},
    {"TurtleDrawing turn-left", TURTLE, "pen turn-left by 60. pen forward by 5."},
    {"TurtleDrawing turn-right", TURTLE, "pen turn-right by 60. pen forward by 5."},
    {"TurtleDrawing set-color", TURTLE, "pen set-color to (1, 0, 0). pen forward by 5."},
    {"TurtleDrawing pen-down", TURTLE "pen pen-up. ", "pen pen-down. pen forward by 5."},
    {"TurtleDrawing pen-up", TURTLE, "pen forward by 2. pen pen-up. pen forward by 2."},
    {"TurtleDrawing push-state", TURTLE "pen push-state. pen turn-left by 90. ", "pen pop-state. pen forward by 5."},
    {"TurtleDrawing pop-state", TURTLE "pen push-state. pen turn-left by 90. ", "pen pop-state. pen forward by 5."},
    {"TurtleDrawing hide-turtle", VIEW "pen = new TurtleDrawing. self zoom-camera to 5. ", "pen hide-turtle."},
    {"TurtleDrawing show-turtle", TURTLE "self zoom-camera to 5. ", "pen show-turtle."},
    {"Line connect", PAIR, "tie = new Line. tie connect from thing to other with-color (1, 0, 0)."},
    {"Line set-color", TIED, "tie set-color to (0, 0, 1)."},
    {"Line set-transparency", TIED, "tie set-transparency to 0."},
    {"Line destroy", TIED, "free tie."},
    {"Spring connect", PAIR "thing enable-physics. other enable-physics. ",
     "tie = ((new Spring) connect from thing to other)."},
    {"Spring set-pattern", SPRUNG, "tie set-pattern to \"----------------\"."},
    {"Spring destroy", SPRUNG, "free tie."},
    {"Patch set-color", CELLS ONE "set-color to (1, 1, 1). ",
     ONE "set-color to (1, 0, 0). " ONE "set-transparency to 1."},
    {"Patch set-transparency", CELLS ONE "set-color to (1, 0, 0). ", ONE "set-transparency to 1."},
    {"PatchGrid init-with", VIEW, CELLS ONE "set-color to (1, 0, 0)."},
    {"PatchGrid disable-volumetric-drawing", CELLS ONE "set-color to (1, 0, 0). ", "cells disable-volumetric-drawing."},
    {"PatchGrid enable-volumetric-drawing", CELLS ONE "set-color to (1, 0, 0). cells disable-volumetric-drawing. ",
     "cells enable-volumetric-drawing."},
    {"PatchGrid display-concentration-in-red", SMELL,
     "cells display-concentration-in-red of-patch-chemical chemical. cells "
     "set-patch-colors-to-chemical-concentrations."},
    {"PatchGrid display-concentration-in-green", SMELL,
     "cells display-concentration-in-green of-patch-chemical chemical. cells "
     "set-patch-colors-to-chemical-concentrations."},
    {"PatchGrid display-concentration-in-blue", SMELL,
     "cells display-concentration-in-blue of-patch-chemical chemical. cells "
     "set-patch-colors-to-chemical-concentrations."},
    {"PatchGrid set-patch-colors-to-chemical-concentrations",
     SMELL "cells display-concentration-in-red of-patch-chemical chemical. ",
     "cells set-patch-colors-to-chemical-concentrations."},
    {"PatchGrid destroy", CELLS ONE "set-color to (1, 0, 0). ", "free cells."},
};

}  // namespace

std::span<const Selector> other_selectors() { return kOthers; }

}  // namespace breve::seeing
