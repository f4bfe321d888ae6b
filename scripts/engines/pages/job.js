// What both pages share: the job that the server states in the page, and the way back.

export const job = JSON.parse(document.getElementById("job").textContent);

/** Pixels across a square of one normal: even, so that the 2 x 2 pixels of a derivative share it. */
export const CELL = 4;

/** Balls of the picture: roughness across, measure down. */
export const BALLS = { size: 160, balls: [0.1, 0.3, 0.5, 0.7, 0.9, 1], rows: ["white metal, one bounce", "grey metal"] };

/** Of the server's page: sends an answer and goes to the next page. */
const { answer } = window;

/** Sends what `work` returns, or why it failed, and goes to the next page. */
export async function finish(work) {
  try {
    await answer(await work());
  } catch (error) {
    await answer({ error: `${error.message}\n${error.stack}` });
  }
}
