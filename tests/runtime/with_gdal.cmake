# Configures a build with GDAL, and builds and runs the tests of files in it.
# Run as: cmake -DSOURCE=DIR -DBUILD=DIR -DGENERATOR=NAME -P with_gdal.cmake
execute_process(COMMAND_ERROR_IS_FATAL ANY COMMAND ${CMAKE_COMMAND} -S ${SOURCE} -B ${BUILD} -G ${GENERATOR}
  -DCMAKE_BUILD_TYPE=Release -DBREVE_QUICK_BUILD=ON -DBREVE_WITH_GDAL=ON -DBREVE_WITH_RENDER=OFF)
execute_process(COMMAND_ERROR_IS_FATAL ANY COMMAND ${CMAKE_COMMAND} --build ${BUILD} --target store_tests)
execute_process(COMMAND_ERROR_IS_FATAL ANY COMMAND ${BUILD}/tests/runtime/store_tests --gtest_filter=HeightRaster.*
  OUTPUT_VARIABLE output)
if(NOT output MATCHES "OK . HeightRaster.GeoTiffIsRead")
  message(FATAL_ERROR "the build has no GDAL:\n${output}")
endif()
