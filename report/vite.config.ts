import { defineConfig } from "vite";
import { viteSingleFile } from "vite-plugin-singlefile";

// Two pages, each one HTML file with everything in it: the report must open from disk, offline.
export default defineConfig(({ mode }) => ({
  plugins: [viteSingleFile({ removeViteModuleLoader: true })],
  build: {
    target: "es2022",
    emptyOutDir: mode !== "workbench",
    chunkSizeWarningLimit: 2000,
    rollupOptions: { input: mode === "workbench" ? "workbench.html" : "index.html" },
  },
}));
