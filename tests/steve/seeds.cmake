# Runs a program with ten seeds: in at least MOST of them its output must match EXPECTED.
# Run as: cmake -DBREVE=FILE -DPROGRAM=FILE -DITERATIONS=N -DEXPECTED=REGEX -DMOST=N -P seeds.cmake
set(found 0)
foreach(seed RANGE 1 10)
  execute_process(COMMAND ${BREVE} run ${PROGRAM} --iterations ${ITERATIONS} --seed ${seed}
    OUTPUT_VARIABLE output ERROR_VARIABLE error RESULT_VARIABLE status)
  if(NOT status EQUAL 0)
    message(FATAL_ERROR "seed ${seed}: ${error}")
  endif()
  if(output MATCHES "${EXPECTED}")
    math(EXPR found "${found} + 1")
  endif()
endforeach()
message(STATUS "${found} of 10 seeds")
if(found LESS MOST)
  message(FATAL_ERROR "only ${found} of 10 seeds match ${EXPECTED} (${MOST} must)")
endif()
