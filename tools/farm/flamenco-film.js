// A film as a job type of Flamenco 3: this file belongs into the folder "scripts" beside flamenco-manager.
const JOB_TYPE = {
    label: "nutik-cl film",
    settings: [
        { key: "frames", type: "string", required: true, description: "Frames of the film, from 0 on: 0-86399" },
        { key: "chunk_size", type: "int32", default: 100, description: "Frames a task" },
        { key: "arguments", type: "string", required: true,
          description: "What follows nutik-cl video, as a JSON list: [\"--out-fps\", \"24\", \"hour.tik\", \"film/%05d.png\"]" },
    ]
};

function compileJob(job) {
    const settings = job.settings;
    const film = JSON.parse(settings.arguments);
    for (const chunk of frameChunker(settings.frames, settings.chunk_size)) {
        const task = author.Task(`frames ${chunk}`, "misc");
        task.addCommand(author.Command("exec", {
            exe: "nutik-cl",
            args: ["video", "--frames", chunk, "--skip-existing", "--progress"].concat(film),
        }));
        job.addTask(task);
    }
}
