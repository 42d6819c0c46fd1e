# Tests of bodies that are registered but do not pass yet: CTest lists them as disabled. Take off what has been mended.
set(not_yet
  physics.adversary_long.balanced
    physics.adversary_long.conserving physics.adversary_long.fast physics.adversary_long.precise
    physics.adversary_long.reference
    physics.overlap_long.balanced physics.overlap_long.conserving
    physics.overlap_long.precise physics.overlap_long.reference)
